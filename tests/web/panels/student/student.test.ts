import { FrameSchema } from "../../../../web/src/gen/phrenic/v1/frames_pb";
import type { PredictionSubject } from "../../../../web/src/graphs/student_graphs";
import type { OnPredicted } from "../../../../web/src/panels/student/prediction_pad";
import { create } from "@bufbuild/protobuf";
import { beforeEach, expect, test, vi } from "vitest";
import { sceneNames, whenShown } from "../../../../web/src/app/lesson_scene";
import { LayerStyles } from "../../../../web/src/appearance/layer_styles";
import { AnswerPhase } from "../../../../web/src/gen/phrenic/v1/answers_pb";
import { type Lesson, LessonSchema, LessonStepSchema } from "../../../../web/src/gen/phrenic/v1/lesson_pb";
import { ParametersSchema } from "../../../../web/src/gen/phrenic/v1/parameters_pb";
import { type Preset, PresetSchema } from "../../../../web/src/gen/phrenic/v1/scene_pb";
import { SessionSchema } from "../../../../web/src/gen/phrenic/v1/session_pb";
import { Choices } from "../../../../web/src/panels/student/choices";
import { compareButton } from "../../../../web/src/panels/student/compare_button";
import { LessonCard } from "../../../../web/src/panels/student/lesson_card";
import { LessonMaker } from "../../../../web/src/panels/student/lesson_maker";
import { sliders } from "../../../../web/src/panels/student/sliders";
import { fullActivations } from "../../../../web/src/parameters/effort";
import { fetchJson } from "../../../../web/src/session/lessons";
import { OwnLessons } from "../../../../web/src/session/own_lessons";
import { SessionController } from "../../../../web/src/session/session_controller";
import { Signal } from "../../../../web/src/state/signal";
import { FakeClock, settle } from "../../fakes/fake_clock";
import { FakeServer } from "../../fakes/fake_server";

let server: FakeServer;
let controller: SessionController;
let presets: Signal<Preset[]>;
let revision = 0n;

const quiet = { diaphragmActivation: 0.06061, intercostalActivation: 0.12, breathLength: 4, ventilatorPressure: 0 };
const receive = (values: object) =>
  controller.receive(
    create(SessionSchema, { revision: ++revision, parameters: create(ParametersSchema, { ...quiet, ...values }) }),
  );
const preset = (name: string, group: string, parameters: object) =>
  create(PresetSchema, { name, group, description: `About ${name}.`, parameters });

beforeEach(() => {
  server = new FakeServer();
  controller = new SessionController(server.api, "thorax", new FakeClock());
  presets = new Signal<Preset[]>([]);
  document.body.replaceChildren();
});

test("ChoicesFollowThePresetThatAnotherViewerChose", () => {
  const { element } = new Choices(controller, presets);
  presets.set([
    preset("quiet", "Breathing patterns", { diaphragmActivation: 0.06061 }),
    preset("copd", "Lungs and pleura", { diaphragmActivation: 0.5 }),
  ]);
  receive({});
  const pressed = () =>
    [...element.querySelectorAll("button")]
      .filter(({ ariaPressed }) => ariaPressed === "true")
      .map((each) => each.textContent);
  expect(pressed()).toEqual(["Healthy", "Quiet"]);
  receive({ diaphragmActivation: 0.5 });
  expect(pressed()).toEqual(["Ill", "Copd"]);
  expect(element.querySelector("#choice-description")!.textContent).toBe("About copd.");
  receive({ diaphragmActivation: 0.3 });
  expect(pressed()).toEqual(["Ill"]);
});

test("RareChoicesAreFolded", () => {
  const { element } = new Choices(controller, presets);
  presets.set([...Array(12).keys()].map((i) => preset(`p${i}`, "Manoeuvres", { breathLength: i + 1 })));
  const count = () => element.querySelectorAll("[data-preset]").length;
  expect(count()).toBe(8);
  element.querySelector<HTMLElement>(".more")!.click();
  expect(count()).toBe(12);
});

const slide = (element: HTMLElement, name: string, position: number) => {
  const input = element.querySelector<HTMLInputElement>(`#effort-${name}`)!;
  input.value = String(position);
  input.oninput?.(new Event("input") as InputEvent);
};

test("TheSlidersSetBothMusclesTheRateAndTheShare", async () => {
  const element = sliders(controller);
  receive({});
  slide(element, "depth", 1);
  await settle();
  const { diaphragmActivation, intercostalActivation } = server.updates[0] as typeof quiet;
  expect(diaphragmActivation! / intercostalActivation!).toBeCloseTo(0.06061 / 0.12, 3);
  expect(
    diaphragmActivation! / fullActivations.diaphragm + intercostalActivation! / fullActivations.intercostal,
  ).toBeCloseTo(2, 3);
  expect(Object.keys(server.updates[0])).not.toContain("breathLength");
});

test("ADepthIsUndoneAsOneChange", () => {
  const element = sliders(controller);
  receive({});
  slide(element, "depth", 1);
  expect(controller.changes.state.value.undo).toBe(true);
  controller.undo();
  expect(controller.changes.state.value.undo).toBe(false);
});

test("AMachineIsPushedWhereMusclesRest", async () => {
  const element = sliders(controller);
  receive({ diaphragmActivation: 0, intercostalActivation: 0, ventilatorPressure: 980 });
  expect(element.textContent).toContain("the machine pushes with 10 cmH₂O");
  expect(element.querySelector<HTMLInputElement>("#effort-share")!.disabled).toBe(true);
  slide(element, "depth", 0.8);
  await settle();
  expect(server.updates).toMatchObject([{ ventilatorPressure: 1961 }]);
});

test("TheComparisonStartsWithTheFirstPresetAndOneButton", async () => {
  presets.set([preset("quiet", "", {}), preset("copd", "", {})]);
  const opened: string[] = [];
  const open = (query: string) => opened.push(query);
  compareButton({ controller, presets, open, close: undefined }).click();
  await settle();
  expect(server.updates).toEqual([{ preset: "quiet" }]);
  expect(opened).toEqual(["?session=thorax&beside=thorax-2"]);
});

const lesson = {
  title: "How we breathe",
  summary: "A breath.",
  scene: "thorax",
  steps: [
    { title: "One", caption: "First.", preset: "quiet" },
    {
      title: "Two",
      caption: "Second.",
      question: {
        words: "Which?",
        answers: [{ words: "this", right: true }, { words: "that" }], // prettier-ignore
        explanation: "Because.",
      },
    },
  ],
};

function card(files: Record<string, unknown>) {
  const played: string[] = [];
  const fetchFile = async (path: string) => {
    if (!(path in files)) throw new Error(`${path}: the server has no such file`);
    return files[path] as never;
  };
  const names = async () => sceneNames("thorax", ["ribs", "lungs"], ["lung volume"]);
  const answers: [place: object, right: boolean][] = [];
  const refusal = new Signal("");
  const stored = new Map<string, string>();
  const storage = { getItem: (key: string) => stored.get(key) ?? null, setItem: (k: string, v: string) => void stored.set(k, v) }; // prettier-ignore
  const own = new OwnLessons(storage);
  const actions = {
    fetchFile,
    names,
    play: (_: unknown, step: { title: string }) => void played.push(step.title),
    answer: (place: object, { right }: { right: boolean }) => void answers.push([place, right]),
    listAnswers: async () => [],
    teaches: new Signal(true),
    own,
    picture: async () => null,
    predicts: () => true,
    predict: (measure: string, done: OnPredicted) => {
      done(measure === "lung volume" ? 0.2 : 9, { unit: "l", digits: 2 } as PredictionSubject);
      return true;
    },
    refusal,
    named: false,
    print: () => undefined,
    keep: async () => create(LessonStepSchema, { preset: "deep", view: { cut: "coronal", cutPosition: 0.4 } }),
  };
  return { card: new LessonCard(actions), played, answers, own, refusal };
}

const submit = (form: HTMLFormElement) => form.onsubmit?.(new Event("submit", { cancelable: true }) as SubmitEvent);

test("ALessonIsPlayedStepByStep", async () => {
  const { card: player, played } = card({ "lessons/one.json": lesson });
  await player.start({ name: "one", step: 1 });
  expect(player.element.textContent).toContain("Step 1 of 2");
  player.move(-1);
  player.move(1);
  player.move(1);
  expect(played).toEqual(["One", "Two"]);
  expect(player.place.value).toEqual({ name: "one", step: 2 });
  player.element.querySelector<HTMLElement>("#lesson-next")!.click();
  expect(player.place.value).toBeUndefined();
});

test("APredictedCurveIsAnAnswerAndNoQuestionOfATest", async () => {
  const drawn = {
    ...lesson,
    steps: [
      {
        title: "One",
        caption: "c",
        question: { words: "Draw it", explanation: "So.", prediction: { measure: "lung volume", tolerance: 0.3 } },
      },
    ],
  };
  const { card: player, answers, refusal } = card({ "lessons/one.json": drawn });
  refusal.set("Anna controls this session.");
  await player.start({ name: "one", step: 1 });
  expect(player.element.querySelector("#lesson-pretest")).toBe(null);
  const start = player.element.querySelector<HTMLButtonElement>("#lesson-predict")!;
  const why = player.element.querySelector<HTMLElement>("#lesson-refusal")!;
  expect([start.disabled, why.hidden, why.textContent]).toEqual([true, false, "Anna controls this session."]);
  refusal.set("");
  expect([start.disabled, why.hidden]).toEqual([false, true]);
  start.click();
  expect(player.element.querySelector(".answer")!.textContent).toBe("0.20 l apart. Right. So.");
  expect(answers).toEqual([[{ lesson: "one", step: 1, phase: 0 }, true]]);
});

test("AFaultOfAPredictionNamesItsField", async () => {
  const alertOf = async (prediction: object, extra: object = {}) => {
    const question = { words: "Draw it", explanation: "So.", prediction, ...extra };
    const { card: player } = card({
      "lessons/one.json": { ...lesson, steps: [{ title: "One", caption: "c", question }] },
    });
    await player.start({ name: "one", step: 1 });
    return player.element.textContent;
  };
  const field = "steps[0].question.prediction";
  expect(await alertOf({ measure: "flow", tolerance: 1 })).toContain(
    `${field}.measure: "flow" is not one of lung volume`,
  );
  expect(await alertOf({ tolerance: 1 })).toContain(`${field}.measure: name a measure`);
  expect(await alertOf({ measure: "lung volume" })).toContain(`${field}.tolerance: it must be above 0`);
  expect(await alertOf({ measure: "lung volume", tolerance: "NaN" })).toContain(`${field}.tolerance`);
  const answers = [{ words: "a", right: true }, { words: "b" }]; // prettier-ignore
  expect(await alertOf({ measure: "lung volume", tolerance: 1 }, { answers })).toContain(`${field}: give either`);
});

test("AWrongAnswerCanBeTriedAgainAndARightOneIsExplained", async () => {
  const { card: player, answers } = card({ "lessons/one.json": lesson });
  await player.start({ name: "one", step: 2 });
  const form = player.element.querySelector("form")!;
  const answer = (i: number) => {
    form.querySelectorAll("input")[i].checked = true;
    form.onsubmit?.(new Event("submit") as SubmitEvent);
    return form.querySelector(".answer")!.textContent;
  };
  form.onsubmit?.(new Event("submit") as SubmitEvent);
  expect(form.textContent).toContain("Choose an answer first.");
  expect(answer(1)).toContain("Not yet.");
  expect(answer(0)).toBe("Right. Because.");
  const place = { lesson: "one", step: 2, phase: AnswerPhase.UNSPECIFIED };
  expect(answers).toEqual([[place, false], [place, true]]); // prettier-ignore
});

test("TheSameQuestionsBeforeAndAfterALessonGiveADifference", async () => {
  const { card: player, answers } = card({ "lessons/one.json": lesson });
  await player.start({ name: "one", step: 1 });
  const take = (choice: number) => {
    const form = player.element.querySelector<HTMLFormElement>("#lesson-test")!;
    form.querySelectorAll("input")[choice].checked = true;
    expect(form.textContent).not.toContain("Because.");
    submit(form);
  };
  player.element.querySelector<HTMLElement>("#lesson-pretest")!.click();
  take(1);
  expect(player.element.textContent).toContain("Step 1 of 2");
  expect(player.element.querySelector("#lesson-pretest")).toBeNull();
  player.move(1);
  player.element.querySelector<HTMLElement>("#lesson-next")!.click();
  take(0);
  const words = "Before the lesson 0 of 1 right, after it 1 of 1: 1 more.";
  expect(player.element.querySelector("#lesson-difference")!.textContent).toBe(words);
  expect(answers.map(([place, right]) => [(place as { phase: AnswerPhase }).phase, right])).toEqual([
    [AnswerPhase.BEFORE, false],
    [AnswerPhase.AFTER, true],
  ]);
});

test("OnlyWhoTeachesSeesTheAnswersOfTheClass", async () => {
  const { card: player } = card({ "lessons/one.json": lesson });
  await player.start({ name: "one", step: 2 });
  expect(player.element.querySelector("#class-results")!.classList.contains("hidden")).toBe(false);
});

const type = (root: HTMLElement, id: string, value: string) =>
  (root.querySelector<HTMLInputElement | HTMLTextAreaElement>(`#${id}`)!.value = value);

test("AViewIsKeptAsAStepAndTheLessonPlayed", async () => {
  const { card: player, played, own } = card({});
  player.element.querySelector<HTMLElement>("#make-lesson")!.click();
  await settle();
  const form = player.element.querySelector<HTMLFormElement>("#step-form")!;
  const press = (words: string) =>
    [...player.element.querySelectorAll("button")].find((each) => each.textContent === words)!.click();
  submit(form);
  await settle();
  expect(form.textContent).toContain("The step cannot be kept: title");
  for (const [id, value] of [
    ["step-title", "A deep breath"],
    ["step-caption", "Both domes fall."],
    ["step-question", "How far?"],
    ["step-answers", "5 ± 1 cm"],
    ["step-explanation", "They pull."],
  ] as const)
    type(form, id, value);
  submit(form);
  await settle();
  press("Leave");
  player.element.querySelector<HTMLElement>("#make-lesson")!.click();
  await settle();
  expect(player.element.querySelector("#maker-steps")!.textContent).toContain("A deep breath");
  press("Save and play");
  expect(player.element.textContent).toContain("The lesson is not complete: title");
  type(player.element, "maker-title", "Tiefe Atemzüge");
  press("Save and play");
  await settle();
  expect(played).toEqual(["A deep breath"]);
  expect(player.place.value).toEqual({ name: "my-tiefe-atemzu-ge", step: 1 });
  const [step] = own.get("my-tiefe-atemzu-ge")!.steps;
  expect(step).toMatchObject({ preset: "deep", view: { cut: "coronal", cutPosition: 0.4 } });
  expect(step.question!.number).toMatchObject({ value: 5, tolerance: 1, unit: "cm" });
});

test("StepsOfALessonAreRemovedAndMovedToAnEarlierPlace", () => {
  const steps = ["One", "Two", "Three"].map((title) => ({ title, caption: "Seen." }));
  const first = create(LessonSchema, { title: "Three", scene: "thorax", steps });
  const saved: string[] = [];
  const making = {
    keep: async () => create(LessonStepSchema),
    save: ({ steps: kept }: Lesson) => `${saved.push(...kept.map(({ title }) => title))}`,
    play: () => undefined,
    leave: () => undefined,
  };
  const { element } = new LessonMaker(making, "thorax", first);
  const press = (words: string, place = 0) =>
    [...element.querySelectorAll("button")].filter((each) => each.textContent === words)[place].click();
  press("Earlier", 1);
  press("Remove");
  press("Save in this browser");
  expect(saved).toEqual(["Three", "Two"]);
});

test("ALessonOfAnotherBrowserIsAskedForAsAFile", async () => {
  const { card: player } = card({});
  await player.start({ name: "my-lesson", step: 1 });
  expect(player.element.textContent).toContain("it is kept in another browser: open its file here");
});

const withView = (view: object) => ({ ...lesson, steps: [{ ...lesson.steps[0], view }] });

test.each([
  ["missing", {}, "the server has no such file"],
  ["../../etc", {}, "is not a name"],
  ["empty", { "lessons/empty.json": { title: "a", summary: "b", scene: "c" } }, "steps: a lesson needs at least one"],
  ["odd", { "lessons/odd.json": { title: "a", steps: [{ colour: "red" }] } }, "colour"],
  ["other", { "lessons/other.json": { ...lesson, scene: "cube" } }, 'this session shows "thorax"'],
  [
    "high",
    { "lessons/high.json": withView({ camera: "above" }) },
    'steps[0].view.camera: "above" is not one of home, ',
  ],
  ["cut", { "lessons/cut.json": withView({ cut: "oblique" }) }, 'steps[0].view.cut: "oblique"'],
  ["red", { "lessons/red.json": withView({ colouring: "red" }) }, 'steps[0].view.colouring: "red" is not one of own, '],
  ["fat", { "lessons/fat.json": withView({ hiddenLayers: ["ribs", "fat"] }) }, 'steps[0].view.hiddenLayers: "fat"'],
])("ABadLessonIsRefusedWithAReason %s", async (name, files, words) => {
  const { card: player } = card(files);
  await player.start({ name, step: 1 });
  expect(player.element.textContent).toContain("This lesson cannot be played");
  expect(player.element.textContent).toContain(words);
  expect(player.place.value).toBeUndefined();
});

/** Returns the list of lessons, opened. */
async function listOf(files: Record<string, unknown>): Promise<HTMLElement> {
  const { element } = card(files).card;
  const fold = element.querySelector("details")!;
  fold.open = true;
  fold.ontoggle?.(new Event("toggle") as ToggleEvent);
  await settle();
  return fold.querySelector("ul")!;
}

test("TheListNamesEveryLessonAboutTheScene", async () => {
  const other = { ...lesson, scene: "cube" };
  const files = { "lessons/index.json": ["one", "two"], "lessons/one.json": lesson, "lessons/two.json": other };
  const list = await listOf(files);
  expect(list.querySelector('[data-lesson="one"]')!.textContent).toBe("How we breatheA breath.");
  expect(list.childElementCount).toBe(1);
});

test("ASceneWithoutLessonsSaysSo", async () => {
  const list = await listOf({ "lessons/index.json": ["two"], "lessons/two.json": { ...lesson, scene: "cube" } });
  expect(list.textContent).toBe("There is no lesson about the scene “thorax”.");
});

test("AListThatIsNotServedIsAnError", async () => {
  expect((await listOf({})).textContent).toContain("The lessons cannot be listed: lessons/index.json");
});

test("TheAnswerOfTheServerIsInTheWords", async () => {
  vi.stubGlobal("fetch", async () => new Response("", { status: 503 }));
  await expect(fetchJson("lessons/a.json")).rejects.toThrow("lessons/a.json: the server answered with HTTP status 503");
  vi.unstubAllGlobals();
});

test("TheNamesOfASceneAreKnownOnceItIsShown", async () => {
  const styles = new LayerStyles();
  const first = create(FrameSchema, { measures: [{ name: "lung volume", unit: "m^3" }] });
  const names = whenShown(controller.session, styles, Promise.resolve(first));
  controller.receive(create(SessionSchema, { scene: "thorax", revision: ++revision }));
  styles.all.set([{ layer: "ribs", title: "Ribs", color: "", opacity: 1, visible: true }]);
  expect(await names).toMatchObject({ scene: "thorax", layers: ["ribs"], predicted: ["lung volume"] });
});
