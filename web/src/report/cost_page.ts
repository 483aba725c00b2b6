import { make } from "../dom/elements";
import {
  type CostRow,
  CostRowSchema,
  type CostTable,
  GrowthRowSchema,
  SizeRowSchema,
  type StageRow,
  StageRowSchema,
} from "../gen/phrenic/v1/study_results_pb";
import { stageBars, variantBars } from "./cost_bars";
import { formatDigits } from "./format";
import { growth } from "./growth";
import { tableOf } from "./table";

/** Returns summary, plots and tables of a cost study. */
export function costParts(table: CostTable): HTMLElement[] {
  const parts: (HTMLElement | undefined)[] = [
    make(
      "div",
      { className: "advice" },
      ...[...summaryOf(table), ...table.notes].map((sentence) => make("p", {}, sentence)),
    ),
    make("h2", {}, "What a step costs"),
    variantBars(table.rows),
    stageBars(table.stages),
    growth(table),
    make("h2", {}, "Tables"),
    tableOf("Variants", CostRowSchema, table.rows),
    table.stages.length === 0 ? undefined : tableOf("Time by stage", StageRowSchema, table.stages),
    table.growth.length === 0 ? undefined : tableOf("Growth", GrowthRowSchema, table.growth),
    table.sizes.length === 0
      ? undefined
      : tableOf("Mesh sizes, with rigid links and without", SizeRowSchema, table.sizes),
  ];
  return parts.filter((part) => part !== undefined);
}

/** Summary: the cost of a step, its largest part, and whether parts that are left out cost nothing. */
function summaryOf({ rows, stages }: CostTable): string[] {
  const full = rows.find(({ variant }) => variant === "full");
  const parts = stages.filter(({ stage }) => stage !== "step").sort((a, b) => b.usPerStep - a.usPerStep);
  return [full && paceOf(full), parts[0] && mostTo(parts[0]), leavingOut(rows)].filter(
    (sentence) => sentence !== undefined,
  );
}

function mostTo({ stage, element }: StageRow): string {
  return `Most of it goes to ${stage === "integrator" ? "the integrator itself" : element}.`;
}

function paceOf({ cpuUsPerStep, timesThesis }: CostRow): string {
  const comparison = timesThesis === undefined ? "" : `, ${formatDigits(timesThesis, 3)} times the speed of the thesis`;
  return `A step takes ${formatDigits(cpuUsPerStep, 3)} µs${comparison}.`;
}

function leavingOut(rows: CostRow[]): string | undefined {
  const ratios = rows.flatMap(({ variant, overNeverHad }) =>
    variant.endsWith("left out") && overNeverHad !== undefined ? [overNeverHad] : [],
  );
  if (ratios.length === 0) return undefined;
  const [least, most] = [Math.min(...ratios), Math.max(...ratios)].map((ratio) => formatDigits(ratio, 3));
  return `Time with a part left out, relative to a scene without it: ${least} to ${most}.`;
}
