import { make } from "../dom/elements";
import { t } from "../language/translate";

/** A key, its description, and its action. */
export interface Shortcut {
  key: string;
  description: string;
  /** True if the key has its action now; otherwise the browser handles it. Not set: always. */
  when?(): boolean;
  run(): void;
}

const pointerGestures: [key: string, words: string][] = [
  ["Drag, arrow keys", "Rotate the view"],
  ["Wheel, + and −", "Zoom in and out"],
  ["Right drag", "Move the view"],
  ["Click", "Pick a vertex"],
  ["Shift and drag", "Pull the tissue"],
  ["Ctrl Z, Ctrl Shift Z", "Undo, redo"],
];

/** Handles keys outside of inputs and dialogs. Returns the dialog that lists them. */
export function shortcuts(all: Shortcut[], undo: () => void, redo: () => void): HTMLDialogElement {
  const dialog = make("dialog", { className: "chooser", id: "help", ariaLabel: t("Keys and gestures") });
  const close = make("button", { type: "button", onclick: () => dialog.close() }, t("Close"));
  const help: Shortcut = { key: "?", description: "Show this list", run: () => dialog.showModal() };
  const keys = [...all, help];
  const rows = [
    ...keys.map(({ key, description }) => [key === " " ? "Space" : key.toUpperCase(), description]),
    ...pointerGestures,
  ];
  const list = rows.flatMap(([key, words]) => [make("dt", {}, make("kbd", {}, t(key))), make("dd", {}, t(words))]);
  dialog.append(
    make("header", {}, make("h2", {}, t("Keys and gestures")), close),
    make("dl", { className: "keys-list" }, ...list),
  );
  document.addEventListener("keydown", (event) => {
    if ((event.target as Element | null)?.closest("dialog, input, select, textarea") || event.altKey) return;
    if (document.querySelector("[aria-modal]") !== null) return;
    if (event.ctrlKey || event.metaKey) return onUndoKey(event, undo, redo);
    // A focused button is pressed by the space bar.
    if (event.key === " " && (event.target as Element | null)?.closest("button, summary, a")) return;
    const shortcut = keys.find(({ key, when }) => key === event.key && (when?.() ?? true));
    if (shortcut === undefined) return;
    event.preventDefault();
    shortcut.run();
  });
  return dialog;
}

function onUndoKey(event: KeyboardEvent, undo: () => void, redo: () => void): void {
  if (event.key.toLowerCase() !== "z") return;
  event.preventDefault();
  if (event.shiftKey) redo();
  else undo();
}
