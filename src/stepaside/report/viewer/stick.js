"use strict";
/* Joystick for touch screens, and gamepad input; sends its position to the server. */
(() => {
  const DEAD_ZONE = 0.25; // fraction of full travel
  const PERIOD = 100; // between two requests, in [ms]
  let sent = "", due = 0, timer = 0;

  /* Send the position of the stick: rightward and upward, each -1 to 1. */
  function send(right, up) {
    const going = Math.hypot(right, up) > DEAD_ZONE && up > -0.3;
    const turn = going ? Math.max(-1, Math.min(1, -right)) : 0;
    const request = `hand?turn=${turn.toFixed(2)}&going=${going ? 1 : 0}`;
    clearTimeout(timer);
    const left = due - performance.now();
    if (left > 0) { timer = setTimeout(() => send(right, up), left); return; }
    if (request === sent) return;
    sent = request;
    due = performance.now() + PERIOD;
    fetch(request, { headers: { "X-Stepaside": "hand" }, cache: "no-store" })
      .catch(() => { sent = ""; });
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
    "Joystick that drives the pursuer; keys: arrows, g (go), h (halt)");
  stick.append(knob);

  let finger = null;
  function follow(event) {
    const box = stick.getBoundingClientRect(), most = 0.5 * box.width;
    let right = (event.clientX - box.left - most) / most;
    let down = (event.clientY - box.top - most) / most;
    const far = Math.max(1, Math.hypot(right, down));
    right /= far;
    down /= far;
    knob.style.transform = `translate(${32 * right}px, ${32 * down}px)`;
    send(right, -down);
  }
  stick.onpointerdown = (event) => {
    finger = event.pointerId;
    stick.setPointerCapture(finger);
    event.preventDefault();
    follow(event);
  };
  stick.onpointermove = (event) => { if (event.pointerId === finger) follow(event); };
  stick.onpointerup = stick.onpointercancel = () => {
    finger = null;
    knob.style.transform = "";
    send(0, 0);
  };

  /* Browsers report a gamepad only after one of its buttons was pressed. */
  let active = false;
  setInterval(() => {
    const pads = navigator.getGamepads ? [...navigator.getGamepads()] : [];
    const pad = pads.find((each) => each && each.axes.length > 1);
    if (!pad || finger !== null) return;
    const [right, down] = pad.axes, deflected = Math.hypot(right, down) > DEAD_ZONE;
    if (deflected || active) send(right, -down);
    active = deflected;
  }, PERIOD);

  document.head.append(style);
  const aside = document.createElement("aside");
  aside.ariaLabel = "Driving";
  aside.append(stick);
  document.body.append(aside);
})();
