import { make } from "../dom/elements";
import { labelledRow, switchRow } from "../dom/rows";
import { Signal } from "../state/signal";
import { angleName, type CArm, standardProjections } from "./c_arm";
import { explanation } from "./explanation";
import type { Tone } from "./gpu_projection";
import { decimal, fixed, t } from "../language/translate";

/** What the controls set. */
export interface Settings {
  arm: Signal<CArm>;
  /** The window of line integrals; undefined until it is computed from a picture. */
  window: Signal<Pick<Tone, "low" | "high"> | undefined>;
  darkBones: Signal<boolean>;
  domes: Signal<boolean>;
}

/** Distances from source to detector [m]; undefined for parallel rays. */
const distances: [number | undefined, string][] = [
  [1.8, "1.8 m, chest stand"],
  [1.2, "1.2 m"],
  [1, "1 m, C-arm"],
  [undefined, "parallel"],
];

/** Returns the controls of the picture: projection, rays and grey. */
export function pictureControls(settings: Settings): HTMLElement[] {
  return [projections(settings.arm), angles(settings.arm), rays(settings.arm), grey(settings)];
}

function projections(arm: Signal<CArm>): HTMLElement {
  const group = make("div", { className: "projections", role: "group", ariaLabel: t("Projection") });
  const buttons = standardProjections.map(({ name, words, lao, cranial }) => {
    const onclick = () => arm.set({ ...arm.value, lao, cranial });
    return make("button", { type: "button", title: t(words), onclick }, t(name));
  });
  arm.subscribe((now) => {
    for (const each of buttons) each.ariaPressed = String(each.textContent === t(angleName(now)));
  });
  group.append(...buttons);
  return group;
}

function angles(arm: Signal<CArm>): HTMLElement {
  const side = slider("fluoroscopy-lao", -180, 180, 5, (lao) => arm.set({ ...arm.value, lao }));
  const tilt = slider("fluoroscopy-cranial", -45, 45, 5, (cranial) => arm.set({ ...arm.value, cranial }));
  const [sideWords, tiltWords] = [make("output"), make("output")];
  arm.subscribe(({ lao, cranial }) => {
    [side.value, tilt.value] = [String(lao), String(cranial)];
    sideWords.value = t(angleName({ lao, cranial: 0 }));
    tiltWords.value = cranial === 0 ? t("level") : `${cranial > 0 ? t("cranial") : t("caudal")} ${Math.abs(cranial)}°`;
    side.setAttribute("aria-valuetext", sideWords.value);
    tilt.setAttribute("aria-valuetext", tiltWords.value);
  });
  const rows = [sliderRow(t("RAO – LAO"), side, sideWords), sliderRow(t("Caudal – cranial"), tilt, tiltWords)];
  return make("div", { className: "fluoroscopy-rows" }, ...rows);
}

function rays(arm: Signal<CArm>): HTMLElement {
  const list = make("select", { id: "fluoroscopy-rays", title: t("Distance from the source to the detector") });
  list.append(...distances.map(([at, words]) => make("option", { value: String(at) }, decimal(t(words)))));
  list.onchange = () => {
    const chosen = distances.find(([at]) => String(at) === list.value);
    arm.set({ ...arm.value, sourceToDetector: chosen?.[0] });
  };
  arm.subscribe(({ sourceToDetector }) => (list.value = String(sourceToDetector)));
  return labelledRow(list.id, t("Source to detector"), list);
}

/** Centre and width of the window, as radiologists set grey, in powers of e of the transmitted intensity. */
function grey({ window, darkBones, domes }: Settings): HTMLElement {
  const set = (centre: number, width: number) => window.set({ low: centre - width / 2, high: centre + width / 2 });
  const centre = slider("fluoroscopy-centre", 0, 12, 0.1, (value) => set(value, Number(width.value)));
  const width = slider("fluoroscopy-width", 0.2, 10, 0.1, (value) => set(Number(centre.value), value));
  const [centreWords, widthWords] = [make("output"), make("output")];
  window.subscribe((now) => {
    if (now === undefined) return;
    [centre.value, width.value] = [String((now.low + now.high) / 2), String(now.high - now.low)];
    [centreWords.value, widthWords.value] = [fixed(Number(centre.value), 1), fixed(Number(width.value), 1)];
  });
  const automatic = make("button", { type: "button", onclick: () => window.set(undefined) }, t("Automatic grey"));
  const dark = switchRow(t("Bones dark"), t("Dark where little passes, as on a fluorescent screen"), (on) =>
    darkBones.set(on),
  );
  const marked = switchRow(t("Mark the domes"), t("A line at the highest point of each dome"), (on) => domes.set(on));
  domes.subscribe((on) => (marked.input.checked = on));
  const rows = [sliderRow(t("Window centre"), centre, centreWords), sliderRow(t("Window width"), width, widthWords)];
  return make("div", { className: "fluoroscopy-rows" }, ...rows, dark.row, marked.row, automatic);
}

function slider(id: string, min: number, max: number, step: number, set: (value: number) => void): HTMLInputElement {
  const input = make("input", { type: "range", id, min: String(min), max: String(max), step: String(step) });
  input.oninput = () => set(Number(input.value));
  return input;
}

function sliderRow(label: string, input: HTMLInputElement, words: HTMLOutputElement): HTMLElement {
  return make("div", { className: "fluoroscopy-row" }, make("label", { htmlFor: input.id }, label), words, input);
}

/** Returns the folded text that says what the picture is made of. */
export function explanationSection(open: string[]): HTMLElement {
  return make("details", {}, make("summary", {}, t("What absorbs, and limits")), ...explanation(open));
}
