import { make } from "../dom/elements";

/** Lets a file be dropped anywhere on the page, and says so while one is held over it. */
export function dropZone(page: HTMLElement, take: (file: File) => void): HTMLElement {
  const words = make("div", { className: "drop-zone", hidden: true }, make("p", {}, "Drop it to compare with it"));
  words.setAttribute("aria-hidden", "true");
  page.addEventListener("dragover", (event) => {
    if (!holdsFiles(event)) return;
    event.preventDefault();
    words.hidden = false;
  });
  page.addEventListener("dragleave", (event) => {
    // Into an element of the page it is no leaving.
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

/** Text and links that are dragged are none of ours. */
function holdsFiles(event: DragEvent): boolean {
  return event.dataTransfer?.types.includes("Files") ?? false;
}
