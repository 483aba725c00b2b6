import { elementById } from "../dom/elements";

/** Window sizes at which graphs and controls are open initially. */
const roomForControls = "(min-width: 761px) and (min-height: 480px)";
const roomForGraphs = "(min-width: 1100px) and (min-height: 560px)";
const roomForGraphsBesideTwo = "(min-width: 1600px) and (min-height: 560px)";
/** On smaller windows only one of the two is open at a time. */
const roomForBoth = "(min-width: 761px)";

/**
 * Opens and closes the controls and the graphs by their buttons. Returns functions that toggle each; calls `onChange`
 * after each change. Two views need more room than one.
 */
export function drawers(onChange: () => void, two: boolean): { graphs(): void; panel(): void } {
  const alone = document.body.classList.contains("embedded");
  const open = (room: string) => !alone && matchMedia(room).matches;
  const panel = drawer("panel", open(roomForControls), onChange);
  const graphs = drawer("graphs", open(two ? roomForGraphsBesideTwo : roomForGraphs), onChange);
  panel.opened = () => matchMedia(roomForBoth).matches || graphs.setOpen(false);
  graphs.opened = () => matchMedia(roomForBoth).matches || panel.setOpen(false);
  return { graphs: () => graphs.toggle(), panel: () => panel.toggle() };
}

function drawer(name: string, open: boolean, folded: () => void) {
  const toggle = elementById(`${name}-toggle`) as HTMLButtonElement;
  const self = {
    opened: (): unknown => undefined,
    setOpen(wanted: boolean): void {
      document.body.classList.toggle(`${name}-open`, wanted);
      toggle.setAttribute("aria-expanded", String(wanted));
      folded();
    },
    toggle(): void {
      const wanted = !document.body.classList.contains(`${name}-open`);
      self.setOpen(wanted);
      if (wanted) self.opened();
    },
  };
  toggle.onclick = () => self.toggle();
  self.setOpen(open);
  return self;
}
