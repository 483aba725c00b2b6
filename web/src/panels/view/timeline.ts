import { button, make } from "../../dom/elements";
import { icon } from "../../dom/icons";
import type { Frames } from "../../frames/frame_buffer";

/** Less than this is not worth looking back on [s]. */
const shortest = 0.5;

/** The last seconds as a slider: the picture stands where it is put, while the simulation does what it does. */
export class Timeline {
  readonly element = make("div", { id: "timeline" });
  private readonly slider = make("input", { type: "range", id: "look-back", step: "any", ariaLabel: "Look back" });
  private readonly words = make("output");
  private readonly live: HTMLButtonElement;

  constructor(
    private readonly frames: Frames,
    private readonly looked: (time: number | undefined) => void,
  ) {
    this.slider.title = "Look back at the last seconds";
    this.slider.oninput = () => this.look(this.slider.valueAsNumber);
    this.live = button("Back to the present", () => this.look(Infinity), icon("play"));
    this.live.id = "look-live";
    this.live.className = "quiet";
    this.element.append(this.slider, this.words, this.live);
  }

  /** One frame earlier, or later. */
  turn(by: -1 | 1): void {
    const { lookedAt } = this.frames;
    if (by > 0 && lookedAt === undefined) return;
    this.look(this.frames.neighbour(by) ?? Infinity);
  }

  get back(): boolean {
    return this.frames.lookedAt !== undefined;
  }

  show(): void {
    const { span, lookedAt } = this.frames;
    this.slider.disabled = span.end - span.start < shortest;
    // Where there is nothing to look back on, the knob stands at the end.
    [this.slider.min, this.slider.max] = [String(Math.min(span.start, span.end - shortest)), String(span.end)];
    const ago = lookedAt === undefined ? 0 : span.end - lookedAt.time;
    if (document.activeElement !== this.slider || lookedAt === undefined) this.slider.value = String(span.end - ago);
    const words = lookedAt === undefined ? "now" : `${ago.toFixed(2)} s ago`;
    if (this.words.textContent !== words) this.words.textContent = words;
    this.slider.setAttribute("aria-valuetext", words);
    const part = span.end > span.start ? 1 - ago / (span.end - span.start) : 1;
    this.slider.style.setProperty("--filled", `${100 * part}%`);
    this.element.classList.toggle("back", lookedAt !== undefined);
    this.live.disabled = lookedAt === undefined;
  }

  private look(time: number): void {
    this.looked(time < this.frames.span.end ? time : undefined);
    this.show();
  }
}
