import { make } from "../dom/elements";
import { t } from "../language/translate";

/** Accepts files that are dropped anywhere on the page, and shows a hint while a file is dragged over it. */
export function dropZone(page: HTMLElement, take: (file: File) => void): HTMLElement {
  const words = make(
    "div",
    { className: "drop-zone", hidden: true },
    make("p", {}, t("Drop the file to compare with it")),
  );
  words.setAttribute("aria-hidden", "true");
  page.addEventListener("dragover", (event) => {
    if (!holdsFiles(event)) return;
    event.preventDefault();
    words.hidden = false;
  });
  page.addEventListener("dragleave", (event) => {
    // The pointer moved to another element of the page.
    if (event.relatedTarget === null) words.hidden = true;
  });
  page.addEventListener("drop", (event) => {
    if (!holdsFiles(event)) return;
    event.preventDefault();
    words.hidden = true;
    const [file] = event.dataTransfer?.files ?? [];
    if (file !== undefined) take(file);
  });
  return words;
}

/** True if the event drags files and not text or links. */
function holdsFiles(event: DragEvent): boolean {
  return event.dataTransfer?.types.includes("Files") ?? false;
}
