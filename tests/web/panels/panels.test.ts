import { create } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, test } from "vitest";
import { make } from "../../../web/src/dom/elements";
import { FrameSchema } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { ParametersSchema } from "../../../web/src/gen/phrenic/v1/parameters_pb";
import { type CompileReport, CompileReportSchema } from "../../../web/src/gen/phrenic/v1/report_pb";
import { type Session, SessionSchema, SessionState } from "../../../web/src/gen/phrenic/v1/session_pb";
import { parameterSections } from "../../../web/src/panels/parameters/parameter_sections";
import { connectionLabels } from "../../../web/src/panels/session/connection_badge";
import { playbackPanel } from "../../../web/src/panels/view/playback";
import { Readout, residualLabel } from "../../../web/src/panels/view/readout";
import { SessionController } from "../../../web/src/session/session_controller";
import { Signal } from "../../../web/src/state/signal";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

let server: FakeServer;
let controller: SessionController;
let panel: HTMLElement;

const session = (breathForce: number, revision: bigint, state = SessionState.PLAYING): Session =>
  create(SessionSchema, {
    revision,
    state,
    speed: 1,
    parameters: create(ParametersSchema, {
      breathForce,
      timeStep: 0.001,
      applyMuscles: true,
    }),
  });
const input = (id: string) => panel.querySelector<HTMLInputElement>(`#${id}`)!;

beforeEach(() => {
  server = new FakeServer();
  controller = new SessionController(server.api, "thorax", new FakeClock());
  panel = make("div", {}, ...parameterSections(controller));
  document.body.replaceChildren(panel);
  controller.receive(session(1, 1n));
});

describe("the control panel", () => {
  test("HasALabelForEveryInput", () => {
    for (const each of panel.querySelectorAll<HTMLInputElement | HTMLSelectElement>("input, select")) {
      expect(Boolean(each.ariaLabel || each.labels?.length), each.id).toBe(true);
    }
  });

  test("ShowsTheValueOfAnotherViewer", () => {
    controller.receive(session(2.5, 2n));
    expect(input("parameter-breathForce").value).toBe("2.5");
    expect(input("parameter-breathForce-entry").value).toBe("2.5");
  });

  test("DoesNotMoveASliderDuringADrag", () => {
    const slider = input("parameter-breathForce");
    slider.onpointerdown?.(new Event("pointerdown") as PointerEvent);
    slider.value = "7";
    controller.receive(session(2.5, 2n));
    expect(slider.value).toBe("7");
  });

  test("SendsATypedNumber", async () => {
    const entry = input("parameter-breathForce-entry");
    entry.value = "1.5";
    entry.onchange?.(new Event("change"));
    await settle();
    expect(server.updates).toMatchObject([{ breathForce: 1.5 }]);
  });

  test("RefusesANumberOutOfRangeWithAMessage", async () => {
    const entry = input("parameter-breathForce-entry");
    entry.value = "21";
    entry.onchange?.(new Event("change"));
    await settle();
    expect(server.updates).toEqual([]);
    expect(panel.textContent).toContain("Breath force must be between 0 and 20.");
    expect(entry.getAttribute("aria-invalid")).toBe("true");
  });
});

test("AParameterWithoutEffectIsHidden", () => {
  const report = new Signal<CompileReport | undefined>(undefined);
  document.body.replaceChildren(...parameterSections(controller, report));
  const hidden = (id: string) => document.querySelector(`#parameter-${id}`)!.closest("[hidden]") !== null;
  expect(hidden("pumpHandle")).toBe(false);
  report.set(create(CompileReportSchema, { idleParameters: ["pump_handle"] }));
  expect([hidden("pumpHandle"), hidden("bucketHandle")]).toEqual([true, false]);
  report.set(create(CompileReportSchema, {}));
  expect(hidden("pumpHandle")).toBe(false);
});

test("EachGroupOfParametersHasASectionUnlessNoneHasAnEffect", () => {
  const report = new Signal<CompileReport | undefined>(undefined);
  const sections = parameterSections(controller, report);
  const titles = () =>
    sections.filter((each) => !each.hidden).map((each) => each.querySelector("summary")!.textContent);
  expect(titles()).toEqual([
    "Breathing",
    "Muscles",
    "Lungs and airways",
    "Walls of a person's lungs",
    "Posture, chest wall and abdomen",
    "Controls of the thesis",
    "Solver",
  ]);
  const [postureSection] = sections.filter((each) => each.querySelector("#parameter-posture") !== null);
  expect(postureSection.querySelectorAll("input, select").length).toBeGreaterThan(3);
  const idleParameters = ["posture", "chest_wall_compliance", "abdominal_compliance", "abdominal_load"].concat([
    "right_cage_compliance",
    "left_cage_compliance",
    "cage_tilt",
    "flail_right",
    "flail_left",
  ]);
  report.set(create(CompileReportSchema, { idleParameters: idleParameters.slice(1) }));
  expect(postureSection.hidden).toBe(false);
  report.set(create(CompileReportSchema, { idleParameters }));
  expect(titles()).not.toContain("Posture, chest wall and abdomen");
});

test("ThePlayButtonIsLabelledByItsAction", () => {
  const play = playbackPanel(controller).querySelector("#play")!;
  expect(play.ariaLabel).toBe("Pause");
  controller.receive(session(1, 2n, SessionState.PAUSED));
  expect(play.ariaLabel).toBe("Play");
  controller.receive(session(1, 3n, SessionState.DIVERGED));
  expect((play as HTMLButtonElement).disabled).toBe(true);
});

test("TheConstraintResidualIsFormatted", () => {
  expect([undefined, 3e-12, 4.2e-4].map(residualLabel)).toEqual(["", "kept", "0.42 mm off"]);
});

test("TheReadoutShowsConstraintsIfThereAreAny", () => {
  const readout = new Readout();
  const shown = () => !readout.element.querySelector<HTMLElement>(".links")!.hidden;
  const rate = { framesPerSecond: 30, age: 4, delay: 0, errorBound: 0.1 };
  const status = { frame: undefined, rate, now: 0, link: { kind: "live" as const } };
  readout.show({ ...status, session: session(1, 1n) });
  expect(shown()).toBe(false);
  readout.show({ ...status, session: create(SessionSchema, { constraintResidual: 0 }) });
  expect(shown()).toBe(true);
});

test("TheReadoutShowsPhaseAndDirectionOfTheBreathAlsoBackwards", () => {
  const readout = new Readout();
  const rate = { framesPerSecond: 30, age: 4, delay: 0, errorBound: 0.1 };
  const status = { session: undefined, rate, now: 0, link: { kind: "live" as const } };
  const shown = (phase: number) => {
    const breath = (1 - Math.cos(2 * Math.PI * phase)) / 2;
    readout.show({ ...status, frame: create(FrameSchema, { phase, breath }) });
    return readout.element.querySelector("#status-breath")!.textContent;
  };
  const words = [0, 0.25, 0.45, 0.625, 0.8, 0.99, 0.02, 0.97, 0.6].map(shown);
  const forwards = ["in 0 %", "in 25 %", "in 45 %", "out 62 %", "out 80 %", "out 99 %", "in 2 %"];
  expect(words).toEqual([...forwards, "out 97 %", "out 60 %"]);
});

test("TheConnectionStateIsFormatted", () => {
  const rate = { framesPerSecond: 30, age: 4.4, delay: 0, errorBound: 0.1 };
  const status = { session: session(1, 1n), frame: undefined, rate, now: 1000 };
  expect(connectionLabels({ ...status, connection: { kind: "live" } })).toMatchObject({
    text: "Live",
    detail: "30 fps, 4 ms, ±0.1 mm",
  });
  const lost = {
    kind: "lost" as const,
    reason: "refused",
    missing: false,
    retryAt: 3500,
  };
  expect(connectionLabels({ ...status, connection: lost })).toMatchObject({ text: "Lost", detail: "retrying in 3 s" });
});
