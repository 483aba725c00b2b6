import type { KeyValueStorage } from "../connection/identity";
import type { Lesson } from "../gen/phrenic/v1/lesson_pb";
import { lessonText, readLessonFile } from "./lesson_file";

const key = "phrenic-lessons";
const maxLessons = 30;

/** The lessons that this browser keeps: made in the page or opened from a file. Their names begin with "my-". */
export class OwnLessons {
  constructor(private readonly storage: KeyValueStorage) {}

  /** Names and lessons, in the order in which they were saved first. */
  all(): { name: string; lesson: Lesson }[] {
    return Object.entries(this.texts()).flatMap(([name, text]) => {
      try {
        return [{ name, lesson: readLessonFile(name, text) }];
      } catch {
        return []; // of another version of the page
      }
    });
  }

  /** Returns the lesson of this name; undefined if this browser has none. */
  get(name: string): Lesson | undefined {
    return this.all().find((each) => each.name === name)?.lesson;
  }

  /**
   * Keeps a lesson, in place of the one with the same title, and returns its name. Throws Error if there is no room.
   */
  put(lesson: Lesson): string {
    const texts = this.texts();
    const name = nameOf(lesson);
    if (!(name in texts) && Object.keys(texts).length >= maxLessons)
      throw new Error(`this browser keeps at most ${maxLessons} lessons: save one as a file and delete it here`);
    this.store({ ...texts, [name]: lessonText(lesson) });
    return name;
  }

  /** Deletes a lesson; does nothing for an unknown name. */
  remove(name: string): void {
    const { [name]: _, ...others } = this.texts();
    this.store(others);
  }

  private store(texts: Record<string, string>): void {
    try {
      this.storage.setItem(key, JSON.stringify(texts));
    } catch {
      throw new Error("this browser has no room for the lesson: save it as a file");
    }
  }

  private texts(): Record<string, string> {
    try {
      const stored: unknown = JSON.parse(this.storage.getItem(key) ?? "{}");
      return typeof stored === "object" && stored !== null ? (stored as Record<string, string>) : {};
    } catch {
      return {};
    }
  }
}

/** Returns a name of letters a-z, digits and "-" for a lesson of this browser. */
function nameOf({ title }: Lesson): string {
  const words = title
    .normalize("NFD")
    .toLowerCase()
    .replaceAll(/[^a-z0-9]+/g, "-")
    .replaceAll(/^-|-$/g, "");
  return `my-${words.slice(0, 60) || "lesson"}`;
}
