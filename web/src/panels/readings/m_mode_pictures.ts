import { make } from "../../dom/elements";
import { switchRow } from "../../dom/rows";
import { type Body, type FrameArrays, positionsOf } from "../../geometry/bodies";
import { crossings, summitOf } from "../../geometry/column";
import { ColumnRecord, paint, pictureDepth, restDepth } from "../../graphs/m_mode";
import type { TimeSpan } from "../../graphs/window";
import { decimal, t } from "../../language/translate";

/** Pixels of a picture. */
const [width, height] = [560, 140];
/** Distance of the marks of depth [m]. */
const markEvery = 0.05;
const help =
  "As an ultrasound probe below the ribs sees the dome: its surfaces are bright lines, which rise when it descends. The grain of the tissue is drawn, not simulated.";

/** One column of the body and its picture. */
interface Column {
  name: string;
  /** Place of the column [m]. */
  x: number;
  y: number;
  record: ColumnRecord;
  canvas: HTMLCanvasElement;
}

/** M-mode pictures of the columns through both domes: brightness by depth over time. A switch shows them. */
export class MModePictures {
  readonly element = make("div", { className: "m-mode", hidden: true });
  private readonly list = make("div", { className: "m-mode-list", hidden: true });
  private readonly input: HTMLInputElement;
  private diaphragm: Body | undefined;
  private columns: Column[] = [];

  /** Keeps `kept` seconds of simulated time. */
  constructor(private readonly kept: number) {
    const { row, input } = switchRow(t("Picture"), t(help), (on) => (this.list.hidden = !on));
    input.id = "m-mode-picture";
    this.input = input;
    this.element.append(row, this.list);
  }

  /** Starts another scene; without a diaphragm there is no picture. */
  start(bodies: Body[]): void {
    this.diaphragm = bodies.find(({ name, triangles }) => name === "diaphragm" && triangles.length > 0);
    this.element.hidden = this.diaphragm === undefined;
    this.columns = this.diaphragm === undefined ? [] : columnsOf(this.diaphragm.rest, this.kept);
    this.list.replaceChildren(...this.columns.map(picture));
  }

  /** Records a frame at a time [s] while the pictures are shown. */
  receive(time: number, arrays: FrameArrays): void {
    const { diaphragm } = this;
    if (diaphragm === undefined || !this.input.checked) return;
    const surface = { positions: positionsOf(diaphragm, arrays), triangles: diaphragm.triangles };
    for (const { x, y, record } of this.columns) record.add(time, crossings(surface, x, y));
  }

  /** Draws a time span. */
  show(span: TimeSpan): void {
    if (this.list.hidden) return;
    for (const { name, record, canvas } of this.columns) {
      const pen = canvas.getContext("2d");
      if (pen === null) return;
      const image = pen.createImageData(width, height);
      paint(image.data, width, record, span);
      pen.putImageData(image, 0, 0);
      const depth = record.newest === undefined ? "" : t(" The dome is at {0} now.", centimetres(record.newest));
      canvas.ariaLabel = t("M-mode picture: {0}. Depth over time. {1}{2}", t(name), t(help), depth);
    }
  }
}

function columnsOf(rest: Float32Array, kept: number): Column[] {
  const sides: [name: string, side: number][] = [
    ["right dome", -1],
    ["left dome", 1],
  ];
  return sides.flatMap(([name, side]) => {
    const summit = summitOf(rest, side);
    if (summit < 0) return [];
    const [x, y, z] = rest.subarray(3 * summit, 3 * summit + 3);
    const canvas = make("canvas", { width, height, role: "img", ariaLabel: t("M-mode picture: {0}", t(name)) });
    return [{ name, x, y, record: new ColumnRecord(z, kept), canvas }];
  });
}

/** A picture with its name and a scale of depth; 10 cm is where the dome is at rest. */
function picture({ name, canvas }: Column): HTMLElement {
  const scale = make("div", { className: "m-mode-scale", ariaHidden: "true" });
  for (let depth = 0; depth < pictureDepth; depth += markEvery) {
    const mark = make("span", {}, depth === 0 ? "0 cm" : (100 * depth).toFixed(0));
    mark.style.top = `${(100 * depth) / pictureDepth}%`;
    scale.append(mark);
  }
  const title = t("Depth from a probe {0} below the dome at rest", centimetres(restDepth));
  return make("figure", { title }, make("figcaption", {}, t(name)), scale, canvas);
}

const centimetres = (metres: number) => `${decimal((100 * metres).toFixed(1).replace(/\.0$/, ""))} cm`;
