import { create } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { FrameSchema } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { graphsOf, valuesOf } from "../../../web/src/graphs/catalogue";
import { toCsv, toSvg } from "../../../web/src/graphs/files";
import { graphData, valueRange } from "../../../web/src/graphs/window";
import { TimeSeries } from "../../../web/src/state/time_series";

const frameAt = (time: number) =>
  create(FrameSchema, {
    time,
    breath: Math.sin(time),
    measures: [
      { name: "lung volume", value: 0.003 + 0.0001 * time, unit: "m^3" },
      { name: "below", value: -0.0001 * time, unit: "m^3" },
      { name: "alveolar pressure", value: -50, unit: "Pa" },
      { name: "pleural pressure", value: -500 - time, unit: "Pa" },
    ],
    probes: [
      { name: "right dome", dz: -0.01 * time },
      { name: "sternum", dz: 0.002 },
    ],
  });
const graphs = graphsOf(frameAt(0));
const graph = (id: string) => graphs.find((each) => each.id === id)!;
const history = new TimeSeries(100);
for (let time = 0; time <= 10; time++) history.add(time, valuesOf(frameAt(time)));

describe("the graphs of a scene", () => {
  test("GroupMeasuresByUnit", () => {
    const words = graphs.map(({ title, unit, curves }) => `${title} [${unit}]: ${curves.map(({ name }) => name)}`);
    expect(words).toEqual([
      "Lung volume [l]: lung volume",
      "M-mode: descent [mm]: right dome",
      "Pressures [Pa]: alveolar pressure,pleural pressure",
      "P–V loop [l]: lung volume",
      "Probes: upward displacement [mm]: sternum",
      "Below [l]: below",
      "Breath wave []: breath",
    ]);
  });

  test("IncludeALoopOfThePleuralPressure", () => {
    expect(graph("loop").abscissa).toMatchObject({ name: "pleural pressure", unit: "Pa" });
    expect(graphsOf(create(FrameSchema, {})).map(({ id }) => id)).toEqual(["breath"]);
  });
});

describe("the data of a graph", () => {
  test("CoverTheSpanWithOnePointOnEitherSide", () => {
    const data = graphData(graph("domes"), history, { start: 3, end: 5 });
    expect(data.times).toEqual([2, 3, 4, 5]);
    expect(data.curves[0].map((value) => Math.round(value))).toEqual([20, 30, 40, 50]);
  });

  test("HaveARangeWithAMargin", () => {
    const [low, high] = valueRange([[1, 2], [3]], 0);
    expect([low, high]).toEqual([1 - 0.16, 3 + 0.16]);
    expect(valueRange([[5, 5]], 2)).toEqual([4, 6]);
    expect(valueRange([[]], 2)).toEqual([-1, 1]);
  });

  test("AreSavedAsCsvWithAllDigits", () => {
    const rows = toCsv(graph("loop"), graphData(graph("loop"), history, { start: 0, end: 10 }))
      .trimEnd()
      .split("\n");
    expect(rows[0]).toBe("time [s],pleural pressure [Pa],lung volume [l]");
    expect(rows).toHaveLength(12);
    expect(rows[4].split(",").map(Number)).toEqual([3, -503, 1000 * (0.003 + 0.0001 * 3)]);
  });

  test("AreSavedAsSvg", () => {
    const spec = { ...graph("pressure"), title: "Pressure < 0 & more" };
    const text = toSvg(spec, graphData(spec, history, { start: 0, end: 10 }));
    const svg = new DOMParser().parseFromString(text, "image/svg+xml");
    const lines = [...svg.querySelectorAll("polyline")];
    expect(lines).toHaveLength(2);
    for (const line of lines) {
      for (const point of line.getAttribute("points")!.split(" ")) {
        const [x, y] = point.split(",").map(Number);
        expect(x >= 0 && x <= 720 && y >= 0 && y <= 360).toBe(true);
      }
    }
    expect(text).toContain("Pressure &lt; 0 &amp; more [Pa]");
    expect(text).toContain("● pleural pressure");
  });
});
