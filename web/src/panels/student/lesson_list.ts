import { make } from "../../dom/elements";
import { alertMessage } from "../../dom/rows";
import type { Lesson } from "../../gen/phrenic/v1/lesson_pb";
import { readLessonFile } from "../../session/lesson_file";
import { checkLesson, type FetchJson, lessonNames, loadLesson, type SceneNames } from "../../session/lessons";
import type { OwnLessons } from "../../session/own_lessons";
import { saveAsFile } from "./save_lesson";
import { t } from "../../language/translate";

/** Where the lessons of the list come from. */
export interface LessonSources {
  fetchFile: FetchJson;
  names(): Promise<SceneNames>;
  own: OwnLessons;
}

/** What the list starts. */
export interface LessonListEvents {
  start(name: string): void;
  /** Makes a lesson, from a copy of `lesson` if there is one. */
  make(lesson: Lesson | undefined): void;
}

/** The lessons about the scene: those of the server, loaded when the list is opened, and those of this browser. */
export class LessonList {
  readonly element = make("details", { id: "lessons" });
  private readonly shipped = make("ul");
  private readonly own = make("ul", { id: "own-lessons" });
  private readonly fault = make("div");

  constructor(
    private readonly sources: LessonSources,
    private readonly events: LessonListEvents,
  ) {
    const file = make("input", { type: "file", id: "lesson-file", accept: ".json,application/json" });
    file.onchange = () => void this.open(file);
    const open = make("label", { htmlFor: file.id }, t("Open a lesson's file"));
    const begin = make("button", { type: "button", id: "make-lesson" }, t("Make a lesson"));
    begin.onclick = () => this.events.make(undefined);
    const actions = make("div", { className: "lesson-files" }, begin, open, file);
    this.element.append(make("summary", {}, t("Lessons")), this.shipped, this.own, actions, this.fault);
    this.element.ontoggle = () => {
      if (this.element.open) void this.fill();
    };
  }

  /** Closes the list. */
  close(): void {
    this.element.open = false;
    this.fault.replaceChildren();
  }

  private async fill(): Promise<void> {
    const { fetchFile, own, names } = this.sources;
    try {
      const { scene } = await names();
      const mine = own.all().filter(({ lesson }) => lesson.scene === scene);
      this.own.replaceChildren(...mine.map(({ name, lesson }) => this.ownRow(name, lesson)));
      if (this.shipped.querySelector("[data-lesson]") !== null) return;
      const all = await lessonNames(fetchFile);
      const lessons = await Promise.all(all.map((name) => loadLesson(name, fetchFile)));
      const rows = lessons.flatMap((lesson, i) => (lesson.scene === scene ? [this.row(all[i], lesson)] : []));
      const none = make("li", {}, t("There is no lesson about the scene “{0}”.", scene));
      this.shipped.replaceChildren(...(rows.length > 0 ? rows : [none]));
    } catch (error) {
      const words = t("The lessons cannot be listed: {0}.", (error as Error).message);
      this.shipped.replaceChildren(make("li", {}, alertMessage(words)));
    }
  }

  private row(name: string, { title, summary }: Lesson): HTMLElement {
    const words = [make("b", {}, title), make("span", {}, summary)];
    const open = make("button", { type: "button", onclick: () => this.events.start(name) }, ...words);
    open.dataset.lesson = name;
    return make("li", {}, open);
  }

  private ownRow(name: string, lesson: Lesson): HTMLElement {
    const row = this.row(name, lesson);
    const remove = () => {
      this.sources.own.remove(name);
      row.remove();
    };
    const acts: [verb: string, act: () => void][] = [
      [t("Change"), () => this.events.make(lesson)],
      [t("Save as file"), () => saveAsFile(lesson)],
      [t("Delete"), remove],
    ];
    const buttons = acts.map(([verb, onclick]) =>
      make("button", { type: "button", className: "small", ariaLabel: `${verb}: ${lesson.title}`, onclick }, verb),
    );
    row.append(make("div", { className: "row" }, ...buttons));
    return row;
  }

  /** Reads a file with the reader of the server's lessons, keeps it in this browser, and plays it. */
  private async open(input: HTMLInputElement): Promise<void> {
    const file = input.files?.[0];
    if (file === undefined) return;
    try {
      const lesson = readLessonFile(file.name, await file.text());
      checkLesson(lesson, await this.sources.names());
      this.fault.replaceChildren();
      this.events.start(this.sources.own.put(lesson));
    } catch (error) {
      this.fault.replaceChildren(alertMessage(t("The lesson cannot be opened: {0}.", (error as Error).message)));
    }
    input.value = "";
  }
}
