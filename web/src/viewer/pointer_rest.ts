/** Time that the pointer rests before it is read, and least time between two readings [ms]. */
const restTime = 120;

/**
 * Calls `rested` when the pointer rests on an element, and `left` when it moves on, is pressed or leaves: so a slow
 * search below the pointer never runs while the view is turned.
 */
export function onPointerRest(element: HTMLElement, rested: (event: PointerEvent) => void, left: () => void): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const stop = () => {
    clearTimeout(timer);
    left();
  };
  element.addEventListener("pointermove", (event) => {
    stop();
    if (event.buttons === 0 && event.pointerType !== "touch") timer = setTimeout(() => rested(event), restTime);
  });
  for (const kind of ["pointerdown", "pointerleave", "wheel"] as const)
    element.addEventListener(kind, stop, { passive: true });
}
