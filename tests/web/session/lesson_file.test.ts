import { create } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { type Lesson, LessonSchema } from "../../../web/src/gen/phrenic/v1/lesson_pb";
import { ParametersSchema } from "../../../web/src/gen/phrenic/v1/parameters_pb";
import { PresetSchema } from "../../../web/src/gen/phrenic/v1/scene_pb";
import { answersOf } from "../../../web/src/panels/student/step_form";
import { keptBreath } from "../../../web/src/parameters/kept_breath";
import { lessonText, readLessonFile } from "../../../web/src/session/lesson_file";
import { OwnLessons } from "../../../web/src/session/own_lessons";

const question = {
  words: "Which?",
  answers: [{ words: "this", right: true }, { words: "that" }],
  explanation: "Because.",
};
const step = { title: "One", caption: "First.", preset: "quiet", question };
const plain = { title: "A breath", summary: "Learn.", scene: "thorax", steps: [step] };
const lesson = create(LessonSchema, plain);
/** The lesson with other fields. */
const changed = (change: object): Lesson => create(LessonSchema, { ...plain, ...change });
const withStep = (change: object) => changed({ steps: [{ ...step, ...change }] });

describe("a lesson's file", () => {
  test("IsReadBackAsItWasWritten", () => {
    const view = { pose: { eye: { x: 1, y: 2, z: 3 }, target: { z: 0.25 } }, cut: "coronal", cutPosition: 0.4 };
    const kept = withStep({ view: { ...view, cutFlipped: true }, parameters: { breathForce: 1.5 } });
    expect(readLessonFile("a.json", lessonText(kept))).toEqual(kept);
  });

  const faulty: [words: string, text: string][] = [
    ["a.json: this is not JSON", "{"],
    ["a.json: this is not JSON", ""],
    ["a.json: cannot decode", "[]"],
    ["colour", '{"colour": 1}'],
    ["title: a lesson needs one", lessonText(changed({ title: " " }))],
    ["scene:", lessonText(changed({ scene: "" }))],
    ["steps: a lesson needs at least one", lessonText(changed({ steps: [] }))],
    ["steps: a lesson has at most 100", lessonText(changed({ steps: Array(101).fill(step) }))],
    ["steps[0].title", lessonText(withStep({ title: "" }))],
    ["steps[0].caption", lessonText(withStep({ caption: "" }))],
    ["steps[0].view.cutPosition: 2 is not", lessonText(withStep({ view: { cutPosition: 2 } }))],
    ["steps[0].view.pose", lessonText(withStep({ view: { pose: { eye: { x: 1 } } } }))],
    ['steps[0].view.measurements[0].tool: "ruler"', lessonText(withStep({ view: { measurements: [{ tool: "ruler" }] } }))], // prettier-ignore
    [
      'steps[0].view.measurements[0].points: "angle" needs 3, not 1',
      lessonText(withStep({ view: { measurements: [{ tool: "angle", points: [{ body: "t1", rest: {} }] }] } })),
    ],
    [
      "steps[0].view.measurements[0].points[0].rest",
      lessonText(withStep({ view: { measurements: [{ tool: "body", points: [{ body: "t1" }] }] } })),
    ],
    [
      "steps[0].view.measurements: a step has at most 12",
      lessonText(withStep({ view: { measurements: Array.from({ length: 13 }, () => ({ tool: "body" })) } })),
    ],
    ["steps[0].question.words", lessonText(withStep({ question: { ...question, words: "" } }))],
    ["steps[0].question.explanation", lessonText(withStep({ question: { ...question, explanation: "" } }))],
    ["give two or more", lessonText(withStep({ question: { ...question, answers: [{ words: "a", right: true }] } }))],
    [
      "mark at least one",
      lessonText(withStep({ question: { ...question, answers: [{ words: "a" }, { words: "b" }] } })),
    ],
    ["either answers or a number", lessonText(withStep({ question: { ...question, number: { value: 1 } } }))],
    ["tolerance", lessonText(withStep({ question: { ...question, answers: [], number: { tolerance: -1 } } }))],
    ["larger than 1 MB", " ".repeat(1_000_001)],
  ];

  test.each(faulty)("ThatIsFaultyIsRefusedWithFileAndField: %s", (words, text) => {
    const read = () => readLessonFile("a.json", text);
    expect(read).toThrow(words);
    expect(read).toThrow("a.json: ");
  });

  test("WithAnyPartMissingOrChangedIsReadOrRefusedWithItsName", () => {
    const text = lessonText(lesson);
    for (let i = 0; i < text.length; i++) {
      for (const other of [text.slice(0, i), `${text.slice(0, i)}7${text.slice(i + 1)}`]) {
        try {
          readLessonFile("a.json", other);
        } catch (error) {
          expect((error as Error).message).toMatch(/^a\.json: /);
        }
      }
    }
  });
});

describe("the lessons of a browser", () => {
  const memory = () => {
    const stored = new Map<string, string>();
    return {
      getItem: (key: string) => stored.get(key) ?? null,
      setItem: (k: string, v: string) => void stored.set(k, v),
    };
  };

  test("AreKeptReplacedByTitleAndDeleted", () => {
    const own = new OwnLessons(memory());
    expect(own.put(lesson)).toBe("my-a-breath");
    own.put(changed({ summary: "Again." }));
    expect(own.all().map(({ lesson: { summary } }) => summary)).toEqual(["Again."]);
    own.remove("my-a-breath");
    expect(own.get("my-a-breath")).toBeUndefined();
  });

  test("AreBounded", () => {
    const own = new OwnLessons(memory());
    for (let i = 0; i < 30; i++) own.put(changed({ title: `Lesson ${i}` }));
    expect(() => own.put(lesson)).toThrow("at most 30");
    expect(() => own.put(changed({ title: "Lesson 3" }))).not.toThrow();
  });

  test("AFullBrowserAndAForeignEntryAreNoFailure", () => {
    const full = { getItem: () => "[]", setItem: () => { throw new Error("QuotaExceededError"); } }; // prettier-ignore
    expect(() => new OwnLessons(full).put(lesson)).toThrow("save it as a file");
    expect(new OwnLessons({ ...full, getItem: () => "nonsense" }).all()).toEqual([]);
    expect(new OwnLessons({ ...full, getItem: () => '{"my-x": "{}"}' }).all()).toEqual([]);
  });
});

describe("answers as they are typed", () => {
  test.each([
    ["1.5 ± 0.2 l", { number: { value: 1.5, tolerance: 0.2, unit: "l" } }],
    ["−3 +- 1 cmH₂O", { number: { value: -3, tolerance: 1, unit: "cmH₂O" } }],
    ["7", { number: { value: 7, tolerance: 0, unit: "" } }],
  ])("AreANumberIfTheyAreOne: %s", (text, given) => expect(answersOf(text)).toEqual(given));

  test("AreChoicesOtherwise", () => {
    expect(answersOf("one\n\n * two \n")).toEqual({
      answers: [
        { words: "one", right: false },
        { words: "two", right: true },
      ],
    });
  });
});

describe("a breath that is kept", () => {
  const presets = [
    create(PresetSchema, { name: "quiet", parameters: { breathForce: 1 } }),
    create(PresetSchema, { name: "deep", parameters: { breathForce: 2 } }),
  ];
  const ofScene = create(ParametersSchema, { breathForce: 1, breathLength: 4 });

  test("IsItsPresetIfOneIsActive", () => {
    const deep = create(ParametersSchema, { breathForce: 2, breathLength: 4 });
    expect(keptBreath(presets, ofScene, deep)).toEqual({ preset: "deep", parameters: undefined });
  });

  test("HasWhatDiffersFromTheFirstPresetOtherwise", () => {
    const odd = create(ParametersSchema, { breathForce: 1.5, breathLength: 3 });
    const { preset, parameters } = keptBreath(presets, ofScene, odd);
    expect(preset).toBe("quiet");
    expect(parameters).toMatchObject({ breathForce: 1.5, breathLength: 3 });
    expect(Object.keys(parameters!).filter((name) => !name.startsWith("$")).sort()).toEqual(["breathForce", "breathLength"]); // prettier-ignore
  });
});
