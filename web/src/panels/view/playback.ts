import { button, make } from "../../dom/elements";
import { icon } from "../../dom/icons";
import { SessionState } from "../../gen/phrenic/v1/session_pb";
import type { SessionController, Speed } from "../../session/session_controller";
import { decimal, t } from "../../language/translate";

const speeds: [string, Speed][] = [
  ["0.1×", 0.1],
  ["0.25×", 0.25],
  ["0.5×", 0.5],
  ["1×", 1],
  ["2×", 2],
  ["4×", 4],
  ["fastest", "fastest"],
];
const strides = [1, 10, 100, 1000];

/** Buttons to play, pause, step and reset, and the speed. */
export function playbackPanel(controller: SessionController): HTMLElement {
  const speed = speedSelect(controller);
  const stride = make("select", { id: "stride", ariaLabel: t("Ticks per step"), title: t("Ticks per step") });
  stride.append(...strides.map((ticks) => option(ticks === 1 ? t("1 tick") : t("{0} ticks", ticks), String(ticks))));
  stride.value = "10";
  const toggle = button(t("Play"), () => void togglePlay(controller, chosenSpeed(speed)), icon("play"));
  toggle.id = "play";
  toggle.className = "primary";
  const step = button(t("Step"), () => void controller.step(Number(stride.value)), icon("step"));
  step.id = "step";
  const reset = button(t("Reset to the start"), () => void controller.reset(), icon("rewind"));
  reset.id = "reset";
  controller.session.subscribe((session) => {
    const playing = session?.state === SessionState.PLAYING;
    toggle.ariaLabel = toggle.title = playing ? t("Pause") : t("Play");
    toggle.replaceChildren(icon(playing ? "pause" : "play"));
    toggle.disabled = step.disabled = session === undefined || session.state === SessionState.DIVERGED;
    reset.disabled = session === undefined;
  });
  return make("div", { className: "playback" }, reset, toggle, step, stride, speed);
}

function togglePlay(controller: SessionController, speed: Speed): Promise<boolean> {
  return controller.session.value?.state === SessionState.PLAYING ? controller.pause() : controller.play(speed);
}

function option(label: string, value: string): HTMLOptionElement {
  return make("option", { value }, label);
}

function speedSelect(controller: SessionController): HTMLSelectElement {
  const select = make("select", { id: "speed", ariaLabel: t("Speed"), title: t("Simulated seconds per second") });
  select.append(
    ...speeds.map(([label, value]) => option(label === "fastest" ? t(label) : decimal(label), String(value))),
  );
  select.onchange = () => {
    if (controller.session.value?.state === SessionState.PLAYING) void controller.play(chosenSpeed(select));
  };
  let known: number | undefined;
  controller.session.subscribe((session) => {
    if (session === undefined || session.speed === known) return;
    known = session.speed;
    show(select, known === 0 ? "fastest" : known);
  });
  return select;
}

/** Adds a speed that another client selected if the list does not have it. */
function show(select: HTMLSelectElement, speed: Speed): void {
  const value = String(speed);
  if (![...select.options].some((option) => option.value === value)) select.append(option(decimal(`${value}×`), value));
  select.value = value;
}

function chosenSpeed(select: HTMLSelectElement): Speed {
  return select.value === "fastest" ? "fastest" : Number(select.value);
}
