import { make } from "../../dom/elements";
import type { ViewOrientation } from "../../viewer/camera_rig";
import type { ViewName } from "../../viewer/named_views";
import { t } from "../../language/translate";

type Triple = [number, number, number];

/** Letter, view, normal and upward direction of each side. */
const sides: [letter: string, name: string, view: ViewName, face: Triple, up: Triple][] = [
  ["A", "the front", "front", [0, -1, 0], [0, 0, 1]],
  ["P", "the back", "back", [0, 1, 0], [0, 0, 1]],
  ["L", "the left", "left", [1, 0, 0], [0, 0, 1]],
  ["R", "the right", "right", [-1, 0, 0], [0, 0, 1]],
  ["S", "above", "top", [0, 0, 1], [0, 1, 0]],
  ["I", "below", "bottom", [0, 0, -1], [0, -1, 0]],
];
/** Half the edge length [CSS pixels]. */
const half = 18;

/** A cube that shows the patient's orientation with radiological letters; each side selects its view. */
export class OrientationCube {
  readonly element = make("div", { id: "cube", role: "group", ariaLabel: t("Sides") });
  private readonly cube = make("div", { className: "cube" });
  private shown = "";

  constructor(go: (view: ViewName) => void) {
    this.element.append(this.cube);
    for (const [letter, name, view, face, up] of sides) {
      const label = t("Look from {0}", t(name));
      const side = make("button", { type: "button", title: label, ariaLabel: label, onclick: () => go(view) }, letter);
      const right = cross(up, face);
      const away = face.map((part) => half * part);
      side.style.transform = matrix(right, negated(up), face, [away[0], away[1], away[2]]);
      this.cube.append(side);
    }
  }

  /** Rotates the cube to the orientation of a view. */
  show({ axes: [right, up, back] }: ViewOrientation): void {
    // The columns are the patient's axes on the screen, where y points down.
    const column = (axis: "x" | "y" | "z"): Triple => [right[axis], -up[axis], back[axis]];
    const transform = matrix(column("x"), column("y"), column("z"), [0, 0, 0]);
    if (transform !== this.shown) this.cube.style.transform = this.shown = transform;
  }
}

function matrix(...columns: [Triple, Triple, Triple, Triple]): string {
  const numbers = columns.flatMap((column, i) => [...column.map((part) => part.toFixed(4)), i === 3 ? "1" : "0"]);
  return `matrix3d(${numbers.join(",")})`;
}

function cross([ax, ay, az]: Triple, [bx, by, bz]: Triple): Triple {
  return [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
}

function negated([x, y, z]: Triple): Triple {
  return [-x, -y, -z];
}
