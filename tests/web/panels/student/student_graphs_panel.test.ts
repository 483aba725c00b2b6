import { create } from "@bufbuild/protobuf";
import { expect, test, vi } from "vitest";
import { FrameSchema } from "../../../../web/src/gen/phrenic/v1/frames_pb";
import { GraphsPanel } from "../../../../web/src/panels/readings/graphs";
import { StudentGraphsPanel } from "../../../../web/src/panels/student/student_graphs_panel";
import { TimeSeries } from "../../../../web/src/state/time_series";

vi.mock("../../../../web/src/graphs/plot", () => ({
  Plot: class {
    readonly element = document.createElement("div");
    show(): void {}
  },
}));

const frame = create(FrameSchema, { measures: [{ name: "lung volume", unit: "m^3", value: 0.0025 }] });

function panel(label: () => string) {
  const shown = new StudentGraphsPanel(new TimeSeries(60), { history: new TimeSeries(60), label }, () => "thorax");
  Object.defineProperty(shown.element, "clientWidth", { value: 300 });
  shown.receive(frame);
  const keys = () => [...shown.element.querySelectorAll(".key span:nth-child(2)")].map((each) => each.textContent);
  return { shown, keys };
}

test("TheCurvesBesideAreNamedByTheActivePreset", () => {
  let label = "Quiet, supine";
  const { shown, keys } = panel(() => label);
  expect(keys()).toEqual(["chosen", "Quiet, supine"]);
  label = "second view";
  shown.draw();
  expect(keys()).toEqual(["chosen", "second view"]);
});

test("TheLegendFollowsTheColoursOfThePage", () => {
  const { shown } = panel(() => "second view");
  const light = vi.spyOn(window, "matchMedia").mockReturnValue({ matches: true } as MediaQueryList);
  const colour = () => shown.element.querySelector<HTMLElement>(".swatch")!.style.color;
  shown.draw();
  const onPaper = colour();
  light.mockReturnValue({ matches: false } as MediaQueryList);
  shown.draw();
  expect(onPaper).not.toBe("");
  expect(colour()).not.toBe(onPaper);
  light.mockRestore();
});

test("ARefusalOfEitherSessionIsShown", () => {
  const { shown } = panel(() => "second view");
  const words = () => shown.element.querySelector("[role=status]")!.textContent;
  shown.refused(["", "there are too many readers"]);
  expect(words()).toBe("No new values: there are too many readers");
  shown.refused(["", ""]);
  expect(words()).toBe("");
});

test("TheExpertsGraphsShowARefusal", () => {
  const graphs = new GraphsPanel(
    () => "thorax",
    () => [],
    () => undefined,
  );
  const words = () => graphs.element.querySelector("#graphs-span")!.textContent;
  const press = () => graphs.element.querySelector<HTMLElement>("#graphs-pause")!.click();
  press();
  graphs.refused("there are too many readers");
  expect(words()).toContain("held");
  press();
  expect(words()).toBe("No new values: there are too many readers");
  graphs.refused("");
  expect(words()).toBe("");
});
