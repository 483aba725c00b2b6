/**
 * Makes the buttons of a toolbar one tab stop, among which the arrow keys, Home and End move the focus. Returns a
 * function to be called when the buttons have changed: the pressed one, or the first, is then the tab stop.
 */
export function oneTabStop(bar: HTMLElement): () => void {
  bar.setAttribute("role", "toolbar");
  const buttons = () => [...bar.querySelectorAll("button")];
  const choose = (chosen: HTMLButtonElement | undefined) => {
    for (const each of buttons()) each.tabIndex = each === chosen ? 0 : -1;
  };
  bar.addEventListener("focusin", (event) => choose((event.target as Element).closest("button") ?? undefined));
  bar.addEventListener("keydown", (event) => {
    const all = buttons();
    const place = all.indexOf(document.activeElement as HTMLButtonElement);
    const next = { ArrowRight: place + 1, ArrowDown: place + 1, ArrowLeft: place - 1, ArrowUp: place - 1, Home: 0, End: -1 }; // prettier-ignore
    const wanted = next[event.key as keyof typeof next];
    if (place < 0 || wanted === undefined) return;
    event.preventDefault();
    all[(wanted + all.length) % all.length].focus();
  });
  return () => {
    const all = buttons();
    if (all.includes(document.activeElement as HTMLButtonElement)) return;
    choose(all.find((each) => each.getAttribute("aria-pressed") === "true") ?? all[0]);
  };
}
