import { place } from "./dom";

/** Where there is room for them, graphs and controls are open at first. */
const roomForControls = "(min-width: 761px) and (min-height: 480px)";
const roomForGraphs = "(min-width: 1100px) and (min-height: 560px)";
const roomForGraphsBesideTwo = "(min-width: 1600px) and (min-height: 560px)";

/**
 * The controls and the graphs fold away by their buttons; the result folds each. `folded` hears of it. Two pictures need
 * more room than one.
 */
export function drawers(folded: () => void, two: boolean): { graphs(): void; panel(): void } {
  const alone = document.body.classList.contains("embedded");
  const open = (room: string) => !alone && matchMedia(room).matches;
  const panel = drawer("panel", open(roomForControls), folded);
  const graphs = drawer("graphs", open(two ? roomForGraphsBesideTwo : roomForGraphs), folded);
  return { graphs, panel };
}

function drawer(name: string, open: boolean, folded: () => void): () => void {
  const toggle = place(`${name}-toggle`) as HTMLButtonElement;
  const fold = (wanted: boolean) => {
    document.body.classList.toggle(`${name}-open`, wanted);
    toggle.setAttribute("aria-expanded", String(wanted));
    folded();
  };
  const turn = () => fold(!document.body.classList.contains(`${name}-open`));
  toggle.onclick = turn;
  fold(open);
  return turn;
}
