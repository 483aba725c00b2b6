import { create } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, test } from "vitest";
import { LessonSchema } from "../../../../web/src/gen/phrenic/v1/lesson_pb";
import { StepPictures } from "../../../../web/src/panels/student/step_pictures";
import { answerSheet, worksheet } from "../../../../web/src/panels/student/worksheet";
import { openWorksheet } from "../../../../web/src/panels/student/worksheet_page";

const lesson = create(LessonSchema, {
  title: "How we breathe",
  summary: "A breath.",
  scene: "thorax",
  steps: [
    { title: "One", caption: "First.", preset: "quiet", task: "Look." },
    {
      title: "Two",
      caption: "Second.",
      question: {
        words: "Which?",
        answers: [{ words: "this", right: true }, { words: "that" }],
        explanation: "Because of that reason.",
      },
    },
    {
      title: "Three",
      caption: "Third.",
      question: { words: "How many?", number: { value: 2.5, tolerance: 0.3, unit: "l" }, explanation: "It is read." },
    },
  ],
});
const none = { pictures: new Map<number, string>(), predicts: false };

describe("a worksheet", () => {
  test("HasEveryStepWithRoomForTheAnswer", () => {
    const sheet = worksheet(lesson, none);
    expect([...sheet.querySelectorAll("h2")].map((each) => each.textContent)).toEqual(["1. One", "2. Two", "3. Three"]);
    const [one, two, three] = sheet.querySelectorAll("section");
    for (const words of ["First.", "Try: Look.", "What I saw:"]) expect(one.textContent).toContain(words);
    expect(one.querySelectorAll(".line").length).toBe(2);
    expect(two.querySelectorAll(".box").length).toBe(2);
    expect(three.querySelectorAll(".blank").length).toBe(1);
    expect(three.textContent).toContain(" l");
  });

  test("TellsNoAnswer", () => {
    const sheet = worksheet(lesson, { ...none, predicts: true });
    for (const secret of ["Because of that reason.", "It is read.", "2.5", "0.3"])
      expect(sheet.textContent).not.toContain(secret);
    // The right answer looks like the others.
    const rows = [...sheet.querySelectorAll("li")].map((each) => each.outerHTML.replace(/this|that/, ""));
    expect(new Set(rows).size).toBe(1);
  });

  test("HasAxesWhereTheBreathChangesAndAPictureOfPlayedSteps", () => {
    const sheet = worksheet(lesson, { pictures: new Map([[2, "blob:two"]]), predicts: true });
    const [one, two, three] = sheet.querySelectorAll("section");
    expect([one, two, three].map((each) => each.querySelectorAll("svg").length)).toEqual([1, 0, 0]);
    expect([one, two, three].map((each) => each.querySelector("img")?.src)).toEqual([undefined, "blob:two", undefined]);
    expect(two.querySelector("img")!.alt).not.toBe("");
  });
});

test("TheAnswerSheetHasTheRightAnswersAndTheirReasons", () => {
  const sheet = answerSheet(lesson);
  const right = [...sheet.querySelectorAll("li")].map((each) => each.textContent);
  expect(right).toEqual(["this", "2.5 l, 0.3 more or less"]);
  for (const each of ["2. Two", "Because of that reason.", "It is read."]) expect(sheet.textContent).toContain(each);
  expect(answerSheet(create(LessonSchema, { title: "x" })).textContent).toContain("no questions");
});

describe("the page of a worksheet", () => {
  let printed: number, closed: number;
  const open = (teaches: boolean) =>
    openWorksheet(lesson, none, { teaches, print: () => printed++, closed: () => closed++ });
  const byId = (id: string) => document.getElementById(id)!;

  beforeEach(() => {
    [printed, closed] = [0, 0];
    document.title = "Phrenic";
    document.body.innerHTML = "<main></main>";
  });

  test("PrintsAndClosesAndGivesThePageBack", () => {
    open(true);
    expect(document.title).toBe("How we breathe");
    expect(document.querySelector("main")!.inert).toBe(true);
    expect(document.activeElement?.id).toBe("worksheet-print");
    byId("worksheet-print").click();
    expect(printed).toBe(1);
    byId("worksheet").dispatchEvent(new KeyboardEvent("keydown", { key: "Escape" }));
    expect(closed).toBe(1);
    expect(document.getElementById("worksheet")).toBeNull();
    expect(document.querySelector("main")!.inert).toBe(false);
    expect(document.title).toBe("Phrenic");
  });

  test("HasTheAnswersOnlyIfATeacherAsks", () => {
    open(true);
    const sheets = document.querySelectorAll<HTMLElement>(".sheet");
    const input = byId("worksheet-answers").querySelector("input")!;
    expect([...sheets].map(({ hidden }) => hidden)).toEqual([false, true]);
    input.click();
    expect([...sheets].map(({ hidden }) => hidden)).toEqual([false, false]);
    byId("worksheet-close").click();
    open(false);
    expect(document.getElementById("worksheet-answers")).toBeNull();
  });
});

test("PicturesOfStepsAreReleased", async () => {
  const live = new Set<string>();
  let count = 0;
  URL.createObjectURL = () => (live.add(`blob:${++count}`), `blob:${count}`);
  URL.revokeObjectURL = (url) => void live.delete(url);
  const pictures = new StepPictures();
  const blob = async () => new Blob(["p"]);
  await pictures.keep(1, blob());
  await pictures.keep(1, blob());
  await pictures.keep(2, Promise.resolve(null));
  expect([...pictures.byStep]).toEqual([[1, "blob:2"]]);
  const late = pictures.keep(3, blob());
  pictures.clear();
  await late;
  expect([pictures.byStep.size, live.size]).toEqual([0, 0]);
});
