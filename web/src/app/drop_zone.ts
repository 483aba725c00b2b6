import { make } from "../dom/elements";
import { t } from "../language/translate";
import type { Dropped } from "../patient/patient_files";

/**
 * Accepts what is dropped anywhere on the page, and shows a hint while it is dragged over it. `take` gets a surface,
 * `takeLabels` label volumes and folders.
 */
export function dropZone(
  page: HTMLElement,
  take: (file: File) => void,
  takeLabels: (dropped: Dropped) => void,
): HTMLElement {
  const words = make(
    "div",
    { className: "drop-zone", hidden: true },
    make("p", {}, t("Drop a surface to compare with it, or a segmentation to make a patient of it")),
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
    const files = [...(event.dataTransfer?.files ?? [])];
    const entries = [...(event.dataTransfer?.items ?? [])].flatMap((item) => item.webkitGetAsEntry() ?? []);
    // A folder, many files, NIfTI, and DICOM, whose files may have no ending.
    if (
      files.length > 1 ||
      entries.some(({ isDirectory }) => isDirectory) ||
      /\.(nii|gz|dcm)$|^[^.]+$/i.test(files[0]?.name)
    )
      takeLabels({ files, entries });
    else if (files.length > 0) take(files[0]);
  });
  return words;
}

/** True if the event drags files and not text or links. */
function holdsFiles(event: DragEvent): boolean {
  return event.dataTransfer?.types.includes("Files") ?? false;
}
