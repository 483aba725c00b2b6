import {
  type ExtremeRow,
  ExtremeRowSchema,
  type LimitRow,
  LimitRowSchema,
  StabilityRowSchema,
  type StabilityTable,
} from "../gen/phrenic/v1/study_results_pb";
import { make } from "../panels/dom";
import { figure } from "./figure";
import { count, formatDigits } from "./format";
import { nameOf } from "./names";
import { mapsOf, stabilityMap, verdictKey } from "./stability_map";
import { tableOf } from "./table";

export function stabilityParts(table: StabilityTable): HTMLElement[] {
  const maps = mapsOf(table);
  return [
    ...(table.extremes.length === 0 ? [] : [make("p", { className: "advice" }, extremesInWords(table.extremes))]),
    make("h2", {}, "Where it is stable"),
    maps.length === 0
      ? make("p", { className: "none" }, "There is no map.")
      : figure(
          "Stability over stiffness and time step.",
          mapsInWords(table.limits),
          verdictKey(table),
          make("div", { className: "tiles" }, ...maps.map(stabilityMap)),
        ),
    make("h2", {}, "Tables"),
    ...(table.extremes.length === 0 ? [] : [tableOf("Extreme cases", ExtremeRowSchema, table.extremes)]),
    tableOf("Largest stable step", LimitRowSchema, table.limits),
    tableOf("All points of the map", StabilityRowSchema, table.map),
  ];
}

/** "12 extreme cases: 9 pass, 3 are stopped with a reason, none FAILED." */
function extremesInWords(rows: ExtremeRow[]): string {
  const of = (verdict: string) => rows.filter((row) => row.verdict === verdict).length;
  const [failed, stopped] = [of("FAILED"), of("stopped")];
  const parts = [
    `${of("pass")} pass`,
    ...(stopped > 0 ? [`${stopped} stopped with a reason`] : []),
    failed === 0 ? "none FAILED" : `${failed} FAILED`,
  ];
  return `${count(rows.length, "extreme case")}: ${parts.join(", ")}.`;
}

function mapsInWords(limits: LimitRow[]): string {
  const ratios = new Map<string, number[]>();
  for (const { integrator, ratio } of limits) {
    if (ratio !== undefined) ratios.set(integrator, [...(ratios.get(integrator) ?? []), ratio]);
  }
  const words = [...ratios].map(([id, values]) => {
    const [low, high] = [Math.min(...values), Math.max(...values)].map((value) => formatDigits(value, 3));
    return `${nameOf(id)} ${low === high ? low : `${low} to ${high}`}`;
  });
  const how =
    "Every cell is one run. Left of the dashed line, the predicted limit, an integrator should be stable; black dots " +
    "are the limit as found by bisection.";
  return words.length === 0 ? how : `${how} Measured over predicted: ${words.join("; ")}.`;
}
