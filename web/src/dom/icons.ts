const shapes = {
  play: "M7 4.5v15l12-7.5z",
  pause: "M6.5 5h4v14h-4zM13.5 5h4v14h-4z",
  step: "M5 5v14l9-7zM16 5h3v14h-3z",
  rewind: "M12 5a7 7 0 1 1-6.7 9h2.1A5 5 0 1 0 12 7v3.6L6.6 6.300 12 2z",
  redo: "M15 5l5 5-5 5v-3.600h-5.500a3 3 0 0 0 0 6H15V20H9.500a5 5 0 0 1 0-11H15z",
  person: "M12 4a4 4 0 1 1 0 8 4 4 0 0 1 0-8zM4 20c0-4 3.6-6 8-6s8 2 8 6z",
  undo: "M9 5 4 10l5 5v-3.600h5.500a3 3 0 0 1 0 6H9V20h5.500a5 5 0 0 0 0-11H9z",
};

/** Names of the icons. */
export type IconName = keyof typeof shapes;

/** Creates an icon. */
export function icon(name: IconName): SVGSVGElement {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(space, "path");
  path.setAttribute("d", shapes[name]);
  svg.append(path);
  return svg;
}
