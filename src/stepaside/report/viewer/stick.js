"use strict";
/* A stick for fingers and gamepads: says how far it is held, and no more. */
(() => {
  const DEAD = 0.25, EVERY = 100; // of the way that holds nothing; in [ms]
  let told = "", due = 0, waiting = 0;

  function tell(right, up) {
    const held = Math.hypot(right, up) > DEAD && up > -0.3;
    const turn = held ? Math.max(-1, Math.min(1, -right)) : 0;
    const says = `hand?turn=${turn.toFixed(2)}&going=${held ? 1 : 0}`;
    clearTimeout(waiting);
    const left = due - performance.now();
    if (left > 0) { waiting = setTimeout(() => tell(right, up), left); return; }
    if (says === told) return;
    told = says;
    due = performance.now() + EVERY;
    fetch(says, { headers: { "X-Stepaside": "hand" }, cache: "no-store" })
      .catch(() => { told = ""; });
  }

  const style = document.createElement("style");
  style.textContent = `
    #stick { position: fixed; left: 8px; bottom: 16px; width: 108px;
      height: 108px; border-radius: 50%; border: 2px solid #5b6470; z-index: 50;
      background: rgb(251 251 249 / 0.72); touch-action: none; display: none; }
    #stick i { position: absolute; left: 32px; top: 32px; width: 40px;
      height: 40px; border-radius: 50%; background: #b4432a; }
    @media (pointer: coarse) { #stick { display: block; } }
    @media (min-width: 700px) { #stick { left: 310px; } }`;
  const stick = document.createElement("div"), knob = document.createElement("i");
  stick.id = "stick";
  stick.setAttribute("role", "img");
  stick.setAttribute("aria-label",
    "Stick that drives the pursuer; the keys are the arrows, g and h");
  stick.append(knob);

  let finger = null;
  function hold(event) {
    const box = stick.getBoundingClientRect(), most = 0.5 * box.width;
    let right = (event.clientX - box.left - most) / most;
    let down = (event.clientY - box.top - most) / most;
    const far = Math.max(1, Math.hypot(right, down));
    right /= far;
    down /= far;
    knob.style.transform = `translate(${32 * right}px, ${32 * down}px)`;
    tell(right, -down);
  }
  stick.onpointerdown = (event) => {
    finger = event.pointerId;
    stick.setPointerCapture(finger);
    event.preventDefault();
    hold(event);
  };
  stick.onpointermove = (event) => { if (event.pointerId === finger) hold(event); };
  stick.onpointerup = stick.onpointercancel = () => {
    finger = null;
    knob.style.transform = "";
    tell(0, 0);
  };

  /* Browsers tell of a gamepad once a button on it was pressed. */
  let moved = false;
  setInterval(() => {
    const pads = navigator.getGamepads ? [...navigator.getGamepads()] : [];
    const pad = pads.find((each) => each && each.axes.length > 1);
    if (!pad || finger !== null) return;
    const [right, down] = pad.axes, held = Math.hypot(right, down) > DEAD;
    if (held || moved) tell(right, -down);
    moved = held;
  }, EVERY);

  document.head.append(style);
  const place = document.createElement("aside");
  place.ariaLabel = "Driving";
  place.append(stick);
  document.body.append(place);
})();
