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

describe("the loops of a thorax", () => {
  // A breath of 0.5 l, of which the abdomen displaces `share`.
  const thoraxAt = (time: number, share: number) =>
    create(FrameSchema, {
      time,
      measures: [
        { name: "lung volume", value: 0.0025 + 0.0005 * Math.sin(time), unit: "m^3" },
        { name: "flow", value: 0.0005 * Math.cos(time), unit: "m^3/s" },
        { name: "pleural pressure", value: -500, unit: "Pa" },
        { name: "displaced by the abdomen", value: 0.0005 * share * Math.sin(time), unit: "m^3" },
      ],
    });
  const loopOf = (id: string, share: number) => {
    const spec = graphsOf(thoraxAt(0, share)).find((each) => each.id === id)!;
    const series = new TimeSeries(100);
    for (let time = 0; time <= 6; time += 0.1) series.add(time, valuesOf(thoraxAt(time, share)));
    return { spec, ...graphData(spec, series, { start: 0, end: 6 }) };
  };

  test("AreInLitres", () => {
    const { spec, abscissa, curves } = loopOf("flow-volume", 0.6);
    expect([spec.unit, spec.abscissa?.unit]).toEqual(["l/s", "l"]);
    // A breath of a sine is an ellipse: (flow / 0.5)^2 + ((volume - 2.5) / 0.5)^2 = 1.
    abscissa!.forEach((volume, i) => expect((curves[0][i] / 0.5) ** 2 + ((volume - 2.5) / 0.5) ** 2).toBeCloseTo(1, 9));
  });

  test.each([
    [0.6, 0.4 / 0.6],
    [0.2, 0.8 / 0.2],
    [-0.25, 1.25 / -0.25],
  ])("KonnoAndMeadsLineHasTheSlopeOfTheShares %d", (share, slope) => {
    const { abscissa, curves } = loopOf("konno-mead", share);
    abscissa!.forEach((below, i) => expect(curves[0][i]).toBeCloseTo(2.5 + slope * below, 9));
  });

  test("AreThoseThatAScenesMeasuresAllow", () => {
    expect(graphs.map(({ id }) => id)).not.toContain("konno-mead");
    expect(graphs.map(({ id }) => id)).not.toContain("flow-volume");
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
