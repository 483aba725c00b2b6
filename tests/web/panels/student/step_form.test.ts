import { create } from "@bufbuild/protobuf";
import { beforeEach, expect, test } from "vitest";
import { type LessonStep, LessonStepSchema, LessonSchema } from "../../../../web/src/gen/phrenic/v1/lesson_pb";
import { LessonMaker } from "../../../../web/src/panels/student/lesson_maker";
import { answersOf, answersText } from "../../../../web/src/panels/student/step_form";

const kept = create(LessonStepSchema, {
  title: "A hole",
  caption: "The lung collapses.",
  preset: "pneumothorax-right",
  view: { camera: "front", cut: "coronal" },
  question: {
    words: "Why?",
    explanation: "Nothing pulls.",
    answers: [{ words: "It is squeezed." }, { words: "Nothing pulls it open.", right: true }],
  },
});

let saved: LessonStep[], views: number;

const fill = (id: string, text: string) => ((document.getElementById(id) as HTMLInputElement).value = text);
const textOf = (id: string) => (document.getElementById(id) as HTMLInputElement).value;
const press = (words: string) =>
  [...document.querySelectorAll("button")].find(({ textContent }) => textContent === words)?.click();
const submit = async () => {
  document.querySelector("form")?.dispatchEvent(new Event("submit", { cancelable: true }));
  await new Promise((done) => setTimeout(done));
};

beforeEach(() => {
  [saved, views] = [[], 0];
  const keep = async () => {
    views++;
    return create(LessonStepSchema, { preset: "quiet" });
  };
  const save = ({ steps }: { steps: LessonStep[] }) => {
    saved = steps;
    return "my-1";
  };
  const lesson = create(LessonSchema, { title: "Mine", scene: "thorax", steps: [kept] });
  const maker = new LessonMaker({ keep, save, play: () => undefined, leave: () => undefined }, "thorax", lesson);
  document.body.replaceChildren(maker.element);
});

test("TheWordsOfAKeptStepAreChangedAndItsViewStays", async () => {
  press("Change");
  expect(textOf("step-caption")).toBe("The lung collapses.");
  expect(textOf("step-answers")).toBe("It is squeezed.\n* Nothing pulls it open.");
  fill("step-caption", "The right lung collapses.");
  fill("step-task", "Look at it.");
  await submit();
  press("Save in this browser");
  expect(views).toBe(0);
  expect(saved).toHaveLength(1);
  expect(saved[0]).toEqual(
    create(LessonStepSchema, { ...kept, caption: "The right lung collapses.", task: "Look at it." }),
  );
  expect(textOf("step-caption")).toBe("");
  expect(document.getElementById("keep-view")?.textContent).toBe("Keep this view as a step");
});

test("CancelledAndRemovedStepsLeaveTheFormForTheNextOne", async () => {
  press("Change");
  press("Cancel");
  press("Save in this browser");
  expect(saved[0].caption).toBe(kept.caption);
  press("Change");
  press("Remove");
  fill("step-title", "New");
  fill("step-caption", "Seen.");
  await submit();
  press("Save in this browser");
  expect(views).toBe(1);
  expect(saved.map(({ title, preset }) => [title, preset])).toEqual([["New", "quiet"]]);
});

test.each(["1.5 ± 0.2 l", "One\n* Two", "-3 ± 0 cmH₂O"])("TheAnswersStayThoseThatWereWritten %s", (text) => {
  expect(answersText(create(LessonStepSchema, { question: answersOf(text) }).question!)).toBe(text);
});
