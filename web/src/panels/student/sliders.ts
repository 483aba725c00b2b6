import { make } from "../../dom/elements";
import type { Parameters } from "../../gen/phrenic/v1/parameters_pb";
import { cmH2O } from "../../graphs/units";
import { activationsOf, effortOf } from "../../parameters/effort";
import type { SessionController } from "../../session/session_controller";
import type { Values } from "../../state/undo_history";
import { fixed, t } from "../../language/translate";

/** Range of the rate [1/min] and the largest pressure of the machine [cmH2O]. */
const [slowest, quickest, strongest] = [4, 60, 25];

interface Words {
  label: string;
  low: string;
  high: string;
}

/** What a slider shows: its position 0 to 1 and the value in words. Not set: the slider has no effect now. */
interface Reading {
  position: number;
  text: string;
}

/**
 * Three sliders in plain words. How deep: both activations together (`effortOf`), or the pressure of a machine that
 * breathes for resting muscles. How fast: the breath length. Chest or belly: the share of the diaphragm.
 */
export function sliders(controller: SessionController): HTMLElement {
  let belly = 0.5; // the share that a breath from rest takes
  const value = () => controller.session.value?.parameters;
  const depth = slider("depth", { label: t("How deep"), low: t("shallow"), high: t("deep") }, (position) =>
    controller.setTogether(depthValues(value(), position, belly)),
  );
  const rate = slider("rate", { label: t("How fast"), low: t("slow"), high: t("fast") }, (position) =>
    controller.setTogether({ breathLength: Number((60 / rateAt(position)).toFixed(2)) }),
  );
  const share = slider("share", { label: t("Chest or belly"), low: t("chest"), high: t("belly") }, (position) =>
    controller.setTogether(activationsOf(effortOf(value() ?? ({} as Parameters)).depth, position)),
  );
  controller.session.subscribe((session) => {
    if (session?.parameters === undefined) return;
    const { parameters } = session;
    belly = effortOf(parameters).belly ?? belly;
    const unanswered = (
      ["diaphragmActivation", "intercostalActivation", "ventilatorPressure", "breathLength"] as const
    ).some((name) => controller.pending(name));
    if (unanswered) return;
    depth.show(depthReading(parameters));
    rate.show(rateReading(parameters));
    share.show(shareReading(parameters));
  });
  return make("section", { id: "efforts", ariaLabel: t("How to breathe") }, depth.element, rate.element, share.element);
}

/** True if a machine breathes and the muscles rest. */
function ventilated(of: Parameters | undefined): boolean {
  return of !== undefined && (of.ventilatorPressure ?? 0) > 0 && effortOf(of).depth === 0;
}

/** The square makes quiet breathing, a tenth of the deepest effort, easy to set. */
function depthValues(of: Parameters | undefined, position: number, belly: number): Values {
  if (ventilated(of)) return { ventilatorPressure: Math.round(Math.max(0.04, position) * strongest * cmH2O) };
  return activationsOf(position ** 2, belly);
}

function depthReading(of: Parameters): Reading {
  const pressure = (of.ventilatorPressure ?? 0) / cmH2O;
  if (ventilated(of))
    return { position: pressure / strongest, text: t("the machine pushes with {0} cmH₂O", fixed(pressure, 0)) };
  const { depth } = effortOf(of);
  const percent = 100 * depth;
  return { position: Math.sqrt(depth), text: t("{0} % of full effort", fixed(percent, percent < 10 ? 1 : 0)) };
}

const rateAt = (position: number) => slowest * (quickest / slowest) ** position;

function rateReading(of: Parameters): Reading {
  const { rate } = effortOf(of);
  const position = Math.log(rate / slowest) / Math.log(quickest / slowest);
  return { position, text: t("{0} breaths a minute", fixed(rate, 0)) };
}

function shareReading(of: Parameters): Reading | undefined {
  const { belly } = effortOf(of);
  if (belly === undefined) return undefined;
  return { position: belly, text: t("{0} % belly", fixed(100 * belly, 0)) };
}

function slider(name: string, { label, low, high }: Words, changed: (position: number) => void) {
  const id = `effort-${name}`;
  const input = make("input", { type: "range", id, min: "0", max: "1", step: "0.01" });
  const output = make("output");
  input.oninput = () => {
    fill(input.valueAsNumber);
    changed(input.valueAsNumber);
  };
  const fill = (position: number) => input.style.setProperty("--filled", `${(100 * position).toFixed(1)}%`);
  const show = (reading: Reading | undefined) => {
    input.disabled = reading === undefined;
    output.textContent = reading?.text ?? t("the muscles rest");
    input.setAttribute("aria-valuetext", output.textContent);
    if (reading === undefined) return;
    const position = Math.min(1, Math.max(0, reading.position));
    input.value = String(position);
    fill(position);
  };
  const end = (words: string) => make("span", { ariaHidden: "true" }, words);
  const ends = make("div", { className: "ends" }, end(low), input, end(high));
  const element = make("div", { className: "effort" }, make("label", { htmlFor: id }, label), output, ends);
  return { element, show };
}
