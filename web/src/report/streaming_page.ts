import { make } from "../dom/elements";
import { StreamingRowSchema, type StreamingTable } from "../gen/phrenic/v1/study_results_pb";
import { bandwidth } from "./bandwidth";
import { formatDigits } from "./format";
import { tableOf } from "./table";

/** Returns advice, plot and table of a streaming study. */
export function streamingParts(table: StreamingTable): HTMLElement[] {
  return [
    make("p", { className: "advice" }, table.advice),
    make("h2", {}, "Bandwidth and accuracy"),
    bandwidth(table),
    measured(table),
    make("h2", {}, "Tables"),
    tableOf("Codecs", StreamingRowSchema, table.rows),
  ];
}

function measured({ vertices, frames, basisBytes }: StreamingTable): HTMLElement {
  const sentence =
    `${formatDigits(Number(vertices), 9)} vertices, ${frames} frames. The codec "basis" needs its shapes once, ` +
    `${formatDigits(Number(basisBytes), 9)} bytes; they were computed from the same number of preceding frames.`;
  return make("section", {}, make("h2", {}, "What was measured"), make("p", {}, sentence));
}
