import { download } from "../../dom/download";
import type { Lesson } from "../../gen/phrenic/v1/lesson_pb";
import { lessonText } from "../../session/lesson_file";

/** Saves a lesson as a file that this page opens. */
export function saveAsFile(lesson: Lesson): void {
  const name = lesson.title.toLowerCase().replaceAll(/[^a-z0-9]+/g, "-").replaceAll(/^-|-$/g, ""); // prettier-ignore
  download(`${name || "lesson"}.json`, new Blob([lessonText(lesson)], { type: "application/json" }));
}
