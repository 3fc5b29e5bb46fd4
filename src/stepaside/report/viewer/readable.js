"use strict";
/* Accessible names, landmarks and contrast that viser's page lacks. */
(() => {
  const NAMES = { // of buttons that show only an icon, by the icon
    "list-search": "Commands", adjustments: "Connection", "device-floppy": "Save",
    x: "Close", "chevron-down": "Collapse", "chevron-up": "Expand",
  };
  const style = document.createElement("style");
  style.textContent = `
    .visually-hidden { position: absolute; width: 1px; height: 1px; margin: -1px;
      overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
    :root[data-mantine-color-scheme="light"] {
      --mantine-color-dimmed: #5c6166 !important; }
    :root[data-mantine-color-scheme="dark"] {
      --mantine-color-dimmed: #a3a8ae !important; }
    /* On a phone the panel covers less than half of the page. */
    @media (max-width: 48em) {
      .mantine-Paper-root[style*="position: fixed"][style*="max-height: 60%"] {
        max-height: 45% !important; } }`;

  function icon(button) {
    for (const name of button.querySelector("svg")?.classList ?? [])
      if (name.startsWith("tabler-icon-")) return name.slice(12);
    return "";
  }

  function nameButton(button) {
    if (button.textContent.trim() || button.ariaLabel || button.title) return;
    const known = NAMES[icon(button)];
    const closes = /closeButton|CloseButton/.test(button.className);
    button.ariaLabel = known || (closes ? "Close" : icon(button) || "More");
  }

  /* The accessible name of a folder begins with its visible title. */
  function nameFolder(folder) {
    const title = folder.innerText.trim();
    if (title && folder.ariaLabel && !folder.ariaLabel.includes(title))
      folder.ariaLabel = `${title}: ${folder.ariaLabel}`;
  }

  /* A slider and its number field take the label of their row. */
  function nameField(field) {
    if (field.ariaLabel || field.labels?.length) return;
    for (let row = field.parentElement; row; row = row.parentElement) {
      const label = row.querySelector("label[for]");
      if (label) { field.ariaLabel = label.textContent; return; }
    }
  }

  function nameAll() {
    document.querySelectorAll("button").forEach(nameButton);
    document.querySelectorAll("div[role=button]").forEach(nameFolder);
    document.querySelectorAll("[role=slider], input").forEach(nameField);
    /* Dialogs and menus open beside viser's root and need a landmark of their own. */
    for (const each of document.body.children)
      if (each.dataset.portal && !each.role) {
        each.role = "region";
        each.ariaLabel = "Dialog";
      }
  }

  let scheduled = false;
  function schedule() {
    if (scheduled) return;
    scheduled = true;
    setTimeout(() => { scheduled = false; nameAll(); }, 250);
  }

  const heading = document.createElement("h1");
  heading.className = "visually-hidden";
  heading.textContent = document.title;
  const header = document.createElement("header");
  header.append(heading);
  document.head.append(style);
  document.body.prepend(header);
  document.getElementById("root").role = "main";
  new MutationObserver(schedule).observe(
    document.body, { childList: true, subtree: true });
  nameAll();
})();
