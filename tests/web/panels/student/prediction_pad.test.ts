import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { ParametersSchema } from "../../../../web/src/gen/phrenic/v1/parameters_pb";
import { SessionSchema } from "../../../../web/src/gen/phrenic/v1/session_pb";
import { PredictionPad } from "../../../../web/src/panels/student/prediction_pad";
import { SessionController } from "../../../../web/src/session/session_controller";
import { TimeSeries } from "../../../../web/src/state/time_series";
import { FakeClock, settle } from "../../fakes/fake_clock";
import { FakeServer } from "../../fakes/fake_server";

const numbers = { below: 0.5, above: 1, nudge: 0.05, digits: 2 };
const air = { key: "v", measure: "lung volume", title: "Air in the lungs", unit: "l", factor: 1000, ...numbers };
const dome = {
  key: "d",
  measure: "right dome",
  title: "Right dome",
  unit: "mm",
  factor: 1000,
  ...numbers,
  nudge: 1,
  digits: 1,
};

test("ABreathIsDrawnByKeysThenPlayedAndMeasured", async () => {
  const server = new FakeServer();
  const controller = new SessionController(server.api, "thorax", new FakeClock());
  controller.receive(create(SessionSchema, { speed: 1, parameters: create(ParametersSchema, { breathLength: 4 }) }));
  const history = new TimeSeries(60);
  for (const time of [0, 1, 2]) history.add(time, [["v", 0.0025]]);
  const pad = new PredictionPad({ controller, history, subjects: () => [air, dome], catchUp: () => Promise.resolve() });
  document.body.replaceChildren(pad.element);
  const press = (id: string) => pad.element.querySelector<HTMLElement>(`#${id}`)!.click();
  press("predict");
  await settle();
  expect(server.paused).toEqual(["thorax"]);
  const key = (name: string) =>
    pad.element.querySelector("svg")!.dispatchEvent(new KeyboardEvent("keydown", { key: name }));
  key("ArrowRight");
  for (let i = 0; i < 10; i++) key("ArrowUp");
  expect(pad.element.querySelector("svg")!.getAttribute("aria-valuetext")).toBe("after 0.1 s: 3.00 l");
  for (let i = 0; i < 50; i++) key("ArrowRight");
  press("predict-play");
  await settle();
  expect(server.played.map(([id]) => id)).toEqual(["thorax"]);
  for (const time of [3, 4, 5, 6]) history.add(time, [["v", 0.0025]]);
  pad.draw();
  expect(pad.element.querySelector("#prediction-words")!.textContent).toContain("0.49 l apart");
  expect(pad.element.querySelector(".seen")!.getAttribute("points")!.split(" ")).toHaveLength(5);
});

test("ABreathThatIsChosenAfterwardsSetsTheSpan", async () => {
  const controller = new SessionController(new FakeServer().api, "thorax", new FakeClock());
  const choose = (breathLength: number, revision: bigint) =>
    controller.receive(
      create(SessionSchema, { revision, speed: 1, parameters: create(ParametersSchema, { breathLength }) }),
    );
  choose(4, 1n);
  const history = new TimeSeries(60);
  history.add(2, [["v", 0.0025]]);
  const pad = new PredictionPad({ controller, history, subjects: () => [air, dome], catchUp: () => Promise.resolve() });
  const words = () => {
    pad.draw();
    return pad.element.querySelector("#prediction-words")!.textContent;
  };
  pad.element.querySelector<HTMLElement>("#predict")!.click();
  await settle();
  choose(8, 2n);
  pad.element.querySelector<HTMLElement>("#predict-play")!.click();
  await settle();
  history.add(7, [["v", 0.0025]]);
  expect(words()).toBe("The breath is played …");
  history.add(10, [["v", 0.0025]]);
  expect(words()).toContain("0.00 l apart");
});

test("AResetEndsThePrediction", async () => {
  const controller = new SessionController(new FakeServer().api, "thorax", new FakeClock());
  const history = new TimeSeries(60);
  history.add(2, [["v", 0.0025]]);
  const pad = new PredictionPad({ controller, history, subjects: () => [air, dome], catchUp: () => Promise.resolve() });
  pad.element.querySelector<HTMLElement>("#predict")!.click();
  await settle();
  pad.element.querySelector<HTMLElement>("#predict-play")!.click();
  history.add(0, [["v", 0.0025]]);
  pad.draw();
  expect(pad.element.querySelector("svg")!.hasAttribute("hidden")).toBe(true);
});

test("AnotherMeasureIsChosenAndMeasuredInItsUnit", async () => {
  const controller = new SessionController(new FakeServer().api, "thorax", new FakeClock());
  const history = new TimeSeries(60);
  history.add(2, [["v", 0.0025], ["d", 0.001]]); // prettier-ignore
  const pad = new PredictionPad({ controller, history, subjects: () => [air, dome], catchUp: () => Promise.resolve() });
  pad.draw();
  const kinds = [...pad.element.querySelectorAll<HTMLButtonElement>(".kinds button")];
  expect(kinds.map(({ textContent, ariaPressed }) => [textContent, ariaPressed])).toEqual([
    ["Air in the lungs", "true"],
    ["Right dome", "false"],
  ]);
  kinds[1].click();
  pad.element.querySelector<HTMLElement>("#predict")!.click();
  await settle();
  expect(pad.element.querySelector("svg")!.getAttribute("aria-label")).toContain("Right dome");
  pad.element.querySelector<HTMLElement>("#predict-play")!.click();
  await settle();
  history.add(60, [["v", 0.0025], ["d", -0.005]]); // prettier-ignore
  pad.draw();
  expect(pad.element.querySelector("#prediction-words")!.textContent).toMatch(/On average they are [\d.]+ mm apart/);
});

test("ALessonAsksForOneMeasureAndGetsTheDistanceOnce", async () => {
  const controller = new SessionController(new FakeServer().api, "thorax", new FakeClock());
  const history = new TimeSeries(60);
  history.add(0, [["v", 0.0025], ["d", 0.001]]); // prettier-ignore
  const pad = new PredictionPad({ controller, history, subjects: () => [air, dome], catchUp: () => Promise.resolve() });
  const told: [number, string][] = [];
  expect(pad.predict("flow", () => undefined)).toBe(false);
  expect(pad.predict("right dome", (distance, { unit }) => told.push([distance, unit]))).toBe(true);
  await settle();
  pad.element.querySelector<HTMLElement>("#predict-play")!.click();
  await settle();
  for (const time of [1, 20]) history.add(time, [["v", 0.0025], ["d", 0.001]]); // prettier-ignore
  pad.draw();
  pad.draw();
  expect(told).toEqual([[0, "mm"]]);
});

function padAt(server: FakeServer) {
  const controller = new SessionController(server.api, "thorax", new FakeClock());
  const history = new TimeSeries(60);
  history.add(2, [["v", 0.0025]]);
  const pad = new PredictionPad({ controller, history, subjects: () => [air], catchUp: () => Promise.resolve() });
  const press = async (id: string) => {
    pad.element.querySelector<HTMLElement>(`#${id}`)!.click();
    await settle();
  };
  const words = () => pad.element.querySelector("#prediction-words")!.textContent;
  const isDrawn = () => !pad.element.querySelector("svg")!.hasAttribute("hidden");
  return { pad, press, words, isDrawn, history };
}

test("ASessionThatMayNotBePausedIsNotPredicted", async () => {
  const server = new FakeServer();
  const { press, words, isDrawn } = padAt(server);
  server.refusal = "Viewers may not pause.";
  await press("predict");
  expect([isDrawn(), words()]).toEqual([false, "Viewers may not pause."]);
  server.refusal = "";
  await press("predict");
  expect(isDrawn()).toBe(true);
  server.refusal = "Viewers may not play.";
  await press("predict-play");
  expect(words()).toBe("Viewers may not play.");
});

test("ABreathWithMissingSamplesIsNotJudged", async () => {
  const { pad, press, words, isDrawn, history } = padAt(new FakeServer());
  pad.interrupt();
  expect(words()).toBe("");
  await press("predict");
  await press("predict-play");
  history.clear();
  pad.interrupt();
  history.add(60, [["v", 0.0025]]);
  pad.draw();
  expect([isDrawn(), words()]).toEqual([false, "A part of the breath is missing: predict again."]);
});
