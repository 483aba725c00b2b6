/** Colours that also differ in lightness, for colour-blind people: on a dark background, and on paper. */
const onDark = ["#ff9b8a", "#7cc7ff", "#ffd166", "#8fe3b0", "#c9a7ff", "#f2f2f2"];
const onPaper = ["#b3261e", "#1565c0", "#9a6700", "#1b7a43", "#6a3fb5", "#333333"];

/** Returns the colour of a curve on the page's background: dark, or light if the user prefers that. */
export function curveColor(order: number): string {
  const light = matchMedia("(prefers-color-scheme: light)").matches;
  const projected = document.documentElement.classList.contains("projector");
  return light && !projected ? paperColor(order) : darkColor(order);
}

/** Returns the colour of a curve on a dark background, such as the stage. */
export function darkColor(order: number): string {
  return onDark[order % onDark.length];
}

/** Returns the colour of a curve on paper. */
export function paperColor(order: number): string {
  return onPaper[order % onPaper.length];
}
