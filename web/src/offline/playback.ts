import { button, make } from "../dom/elements";
import { icon } from "../dom/icons";
import type { Player } from "./player";
import { fixed, t } from "../language/translate";

const speeds = [0.25, 0.5, 1, 2];

/** Returns a button that plays and pauses, and a choice of the speed. */
export function playback(player: Player): HTMLElement {
  const toggle = button(t("Play"), () => player.setPlaying(!player.playing.value), icon("play"));
  toggle.id = "play";
  toggle.className = "primary";
  player.playing.subscribe((playing) => {
    toggle.ariaLabel = toggle.title = playing ? t("Pause") : t("Play");
    toggle.replaceChildren(icon(playing ? "pause" : "play"));
  });
  const speed = make("select", { id: "speed", ariaLabel: t("Speed"), title: t("Simulated seconds per second") });
  speed.append(...speeds.map((value) => make("option", { value: String(value) }, `${value}×`)));
  speed.value = "1";
  speed.onchange = () => (player.speed = Number(speed.value));
  return make("div", { className: "playback" }, toggle, speed);
}

/** Returns a slider over the motion, of this length [s], that pauses and shows the chosen time. */
export function scrubber(player: Player, length: number): HTMLElement {
  const slider = make("input", { type: "range", id: "scrub", min: "0", step: "any", ariaLabel: t("Time") });
  slider.max = String(length || 1);
  slider.disabled = length === 0;
  const words = make("output");
  slider.oninput = () => player.showAt(slider.valueAsNumber);
  // Arrow keys move by a fiftieth; the browser's own step of a slider without steps is a tenth.
  slider.onkeydown = (event) => {
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    player.showAt(player.time.value + (by * length) / 50);
  };
  player.time.subscribe((time) => {
    slider.value = String(time);
    slider.style.setProperty("--filled", `${(100 * time) / (length || 1)}%`);
    const text = t("{0} of {1} s", fixed(time, 2), fixed(length, 2));
    if (words.textContent === text) return;
    words.textContent = text;
    slider.setAttribute("aria-valuetext", text);
  });
  return make("div", { id: "timeline" }, slider, words);
}
