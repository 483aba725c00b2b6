import { make } from "../dom/elements";
import {
  type ExtremeRow,
  ExtremeRowSchema,
  type LimitRow,
  LimitRowSchema,
  type StabilityRow,
  StabilityRowSchema,
  type StabilityTable,
} from "../gen/phrenic/v1/study_results_pb";
import { figure } from "./figure";
import { count, formatDigits, formatTicks } from "./format";
import { seriesName } from "./names";
import { stabilityMap, stabilityMaps, verdictKey } from "./stability_map";
import { tableOf } from "./table";

/** Returns summary, maps and tables of a stability study. */
export function stabilityParts(table: StabilityTable): HTMLElement[] {
  const maps = stabilityMaps(table);
  return [
    make("div", { className: "advice" }, ...summaryOf(table).map((sentence) => make("p", {}, sentence))),
    make("h2", {}, "Stability maps"),
    maps.length === 0
      ? make("p", { className: "none" }, "There is no map.")
      : figure(
          "Stability over stiffness and time step.",
          mapCaption(table.limits),
          verdictKey(table),
          make("div", { className: "tiles" }, ...maps.map(stabilityMap)),
        ),
    make("h2", {}, "Tables"),
    ...(table.extremes.length === 0 ? [] : [tableOf("Extreme cases", ExtremeRowSchema, table.extremes)]),
    tableOf("Largest stable step", LimitRowSchema, table.limits),
    tableOf("All points of the map", StabilityRowSchema, table.map),
  ];
}

/** Summary: largest stable steps, unconditionally stable integrators, and results of the extreme cases. */
function summaryOf(table: StabilityTable): string[] {
  const extremes = table.extremes.length === 0 ? [] : [extremeCaseSummary(table.extremes)];
  return [longestSteps(table.limits), alwaysStable(table.map), ...extremes].filter(Boolean);
}

/** Returns "Longest stable step: Velocity Verlet 24.6 ms, at 10⁶ times the stiffness 0.0246 ms." */
function longestSteps(limits: LimitRow[]): string {
  const steps = [...new Set(limits.map(({ integrator }) => integrator))].flatMap((integrator) => {
    const own = limits.filter((row) => row.integrator === integrator && row.measuredS !== undefined);
    const [first, last] = [own[0], own[own.length - 1]];
    if (first === undefined) return [];
    const soft = `${seriesName(integrator)} ${milliseconds(first)}`;
    return first === last ? [soft] : [`${soft} (${times(last.stiffness)} as stiff: ${milliseconds(last)})`];
  });
  return steps.length === 0 ? "" : `Longest stable step: ${steps.join(", ")}.`;
}

const times = (factor: number) => `${formatTicks([factor])(factor)} times`;
const milliseconds = ({ measuredS }: LimitRow) => `${formatDigits(1e3 * measuredS!, 3)} ms`;

function alwaysStable(map: StabilityRow[]): string {
  const good = ["stable", "damped"];
  const always = [...new Set(map.map(({ integrator }) => integrator))].filter((integrator) =>
    map.every((row) => row.integrator !== integrator || good.includes(row.verdict)),
  );
  return always.length === 0
    ? ""
    : `Stable at every stiffness and step of the map: ${always.map(seriesName).join(", ")}.`;
}

/** Returns "12 extreme cases: 9 pass, 3 stopped with a reason, none FAILED." */
function extremeCaseSummary(rows: ExtremeRow[]): string {
  const of = (verdict: string) => rows.filter((row) => row.verdict === verdict).length;
  const [failed, stopped] = [of("FAILED"), of("stopped")];
  const parts = [
    `${of("pass")} pass`,
    ...(stopped > 0 ? [`${stopped} stopped with a reason`] : []),
    failed === 0 ? "none FAILED" : `${failed} FAILED`,
  ];
  return `${count(rows.length, "extreme case")}: ${parts.join(", ")}.`;
}

function mapCaption(limits: LimitRow[]): string {
  const ratios = new Map<string, number[]>();
  for (const { integrator, ratio } of limits) {
    if (ratio !== undefined) ratios.set(integrator, [...(ratios.get(integrator) ?? []), ratio]);
  }
  const words = [...ratios].map(([id, values]) => {
    const [low, high] = [Math.min(...values), Math.max(...values)].map((value) => formatDigits(value, 3));
    return `${seriesName(id)} ${low === high ? low : `${low} to ${high}`}`;
  });
  const how =
    "Every cell is one run. Left of the dashed line, the predicted limit, an integrator should be stable; black dots " +
    "are the limit as found by bisection.";
  return words.length === 0 ? how : `${how} Measured over predicted: ${words.join("; ")}.`;
}
