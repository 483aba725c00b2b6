import { CostRowSchema, type CostTable, GrowthRowSchema, StageRowSchema } from "../gen/phrenic/v1/study_results_pb";
import { make } from "../panels/dom";
import { stageBars, variantBars } from "./cost_bars";
import { growth } from "./growth";
import { tableOf } from "./table";

export function costParts(table: CostTable): HTMLElement[] {
  const parts: (HTMLElement | undefined)[] = [
    make("h2", {}, "What a step costs"),
    variantBars(table.rows),
    stageBars(table.stages),
    growth(table),
    make("h2", {}, "Tables"),
    tableOf("Variants", CostRowSchema, table.rows),
    table.stages.length === 0 ? undefined : tableOf("Time by stage", StageRowSchema, table.stages),
    table.growth.length === 0 ? undefined : tableOf("Growth", GrowthRowSchema, table.growth),
  ];
  return parts.filter((part) => part !== undefined);
}
