import { make } from "../dom/elements";
import { PhysiologyRowSchema, type PhysiologyTable, Verdict } from "../gen/phrenic/v1/physiology_pb";
import { breathCurves } from "./breath_curves";
import { tableOf } from "./table";

/** Returns the curves of one breath at a time, and the rows. */
export function physiologyParts(table: PhysiologyTable): HTMLElement[] {
  const count = (verdict: Verdict) => table.rows.filter((row) => row.verdict === verdict).length;
  const [inside, outside] = [count(Verdict.INSIDE), count(Verdict.OUTSIDE)];
  return [
    make("p", { className: "advice" }, `${inside} of ${inside + outside} values are inside their ranges.`),
    switched(table),
    make("h2", {}, "Tables"),
    ...[
      ["Outside", Verdict.OUTSIDE] as const,
      ["Inside", Verdict.INSIDE] as const,
      ["Without a published range", Verdict.NOT_JUDGED] as const,
      ["Not applicable to this scene", Verdict.NOT_MODELLED] as const,
    ].map(([title, verdict]) =>
      tableOf(
        title,
        PhysiologyRowSchema,
        table.rows.filter((row) => row.verdict === verdict),
      ),
    ),
  ];
}

/** The curves of a breath, with a choice of the breath. */
function switched({ curves }: PhysiologyTable): HTMLElement {
  const frame = make("div", {});
  const breaths = [...new Set(curves.map(({ breath }) => breath))];
  const show = (breath: string) =>
    frame.replaceChildren(...breathCurves(curves.filter((curve) => curve.breath === breath)));
  const choices = breaths.map((breath, i) => {
    const input = make("input", { type: "radio", name: "breath", checked: i === 0 });
    input.onchange = () => show(breath);
    return make("label", {}, input, breath);
  });
  if (breaths.length > 0) show(breaths[0]);
  const choice = make("fieldset", { className: "choice" }, make("legend", {}, "Breath shown"), ...choices);
  return make("section", {}, make("h2", {}, "Curves"), choice, frame);
}
