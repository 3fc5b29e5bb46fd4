"use strict";
/* What viser's page lacks for those who hear it read or see little contrast. */
(() => {
  const NAMES = { // of buttons that show a sign alone, by the sign
    "list-search": "Commands", adjustments: "Connection", "device-floppy": "Save",
    x: "Close", "chevron-down": "Fold", "chevron-up": "Unfold",
  };
  const style = document.createElement("style");
  style.textContent = `
    .unseen { position: absolute; width: 1px; height: 1px; margin: -1px;
      overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
    :root[data-mantine-color-scheme="light"] {
      --mantine-color-dimmed: #5c6166 !important; }
    :root[data-mantine-color-scheme="dark"] {
      --mantine-color-dimmed: #a3a8ae !important; }
    /* The sheet of a phone leaves the robots more than half of the page. */
    @media (max-width: 48em) {
      .mantine-Paper-root[style*="position: fixed"][style*="max-height: 60%"] {
        max-height: 45% !important; } }`;

  function sign(button) {
    for (const name of button.querySelector("svg")?.classList ?? [])
      if (name.startsWith("tabler-icon-")) return name.slice(12);
    return "";
  }

  function nameButton(button) {
    if (button.textContent.trim() || button.ariaLabel || button.title) return;
    const known = NAMES[sign(button)];
    const closes = /closeButton|CloseButton/.test(button.className);
    button.ariaLabel = known || (closes ? "Close" : sign(button) || "More");
  }

  /* What is said of a fold begins with what is written on it. */
  function nameFold(fold) {
    const words = fold.innerText.trim();
    if (words && fold.ariaLabel && !fold.ariaLabel.includes(words))
      fold.ariaLabel = `${words}: ${fold.ariaLabel}`;
  }

  /* A slider and the number beside it are called what their row is called. */
  function nameField(field) {
    if (field.ariaLabel || field.labels?.length) return;
    for (let row = field.parentElement; row; row = row.parentElement) {
      const label = row.querySelector("label[for]");
      if (label) { field.ariaLabel = label.textContent; return; }
    }
  }

  function attend() {
    document.querySelectorAll("button").forEach(nameButton);
    document.querySelectorAll("div[role=button]").forEach(nameFold);
    document.querySelectorAll("[role=slider], input").forEach(nameField);
    /* what opens over the page stands beside viser's root, in a place of its own */
    for (const each of document.body.children)
      if (each.dataset.portal && !each.role) {
        each.role = "region";
        each.ariaLabel = "Opened";
      }
  }

  let asked = false;
  function soon() {
    if (asked) return;
    asked = true;
    setTimeout(() => { asked = false; attend(); }, 250);
  }

  const heading = document.createElement("h1");
  heading.className = "unseen";
  heading.textContent = document.title;
  const header = document.createElement("header");
  header.append(heading);
  document.head.append(style);
  document.body.prepend(header);
  document.getElementById("root").role = "main";
  new MutationObserver(soon).observe(
    document.body, { childList: true, subtree: true });
  attend();
})();
