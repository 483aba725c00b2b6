/** Draws the lines, polylines, circles and texts of an SVG over the page onto a canvas, as their styles show them. */
export function paintSvg(element: SVGSVGElement, pen: CanvasRenderingContext2D, ratio: number): void {
  pen.save();
  pen.scale(ratio, ratio);
  pen.lineJoin = "round";
  for (const shape of element.querySelectorAll<SVGElement>("line, polyline, circle, text")) {
    const style = getComputedStyle(shape);
    [pen.fillStyle, pen.strokeStyle, pen.lineWidth] = [style.fill, style.stroke, parseFloat(style.strokeWidth)];
    if (shape.tagName === "text") paintText(shape, style, pen);
    else paintShape(shape, pen);
  }
  pen.restore();
}

/**
 * Draws the texts of the innermost spans of an element over the page onto a canvas, word by word where they are; words
 * that the element cuts off are left out.
 */
export function paintTexts(element: HTMLElement, pen: CanvasRenderingContext2D, ratio: number): void {
  const origin = element.getBoundingClientRect();
  const range = document.createRange();
  pen.save();
  pen.scale(ratio, ratio);
  pen.textBaseline = "middle";
  for (const span of element.querySelectorAll<HTMLElement>("span:not(:has(*))")) {
    const { fontStyle, fontWeight, fontSize, fontFamily, color } = getComputedStyle(span);
    [pen.font, pen.fillStyle] = [`${fontStyle} ${fontWeight} ${fontSize} ${fontFamily}`, color];
    const end = span.getBoundingClientRect().right + 1;
    for (const { 0: word, index } of (span.textContent ?? "").matchAll(/\S+/g)) {
      range.setStart(span.firstChild!, index);
      range.setEnd(span.firstChild!, index + word.length);
      const { left, right, top, height } = range.getBoundingClientRect();
      if (right <= end) pen.fillText(word, left - origin.left, top + height / 2 - origin.top);
    }
  }
  pen.restore();
}

const numberOf = (shape: SVGElement, name: string) => Number(shape.getAttribute(name));

function paintText(shape: SVGElement, style: CSSStyleDeclaration, pen: CanvasRenderingContext2D): void {
  const anchors: Record<string, CanvasTextAlign> = { start: "left", middle: "center", end: "right" };
  pen.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  pen.textAlign = anchors[shape.getAttribute("text-anchor") ?? "start"];
  const at = [shape.textContent, numberOf(shape, "x"), numberOf(shape, "y")] as const;
  if (style.stroke !== "none") pen.strokeText(...at);
  pen.fillText(...at);
}

function paintShape(shape: SVGElement, pen: CanvasRenderingContext2D): void {
  pen.beginPath();
  if (shape.tagName === "circle") {
    pen.arc(numberOf(shape, "cx"), numberOf(shape, "cy"), numberOf(shape, "r"), 0, 2 * Math.PI);
    return pen.fill();
  }
  const ends =
    shape.tagName === "line"
      ? [1, 2].map((i) => [numberOf(shape, `x${i}`), numberOf(shape, `y${i}`)])
      : (shape.getAttribute("points") ?? "").split(" ").map((pair) => pair.split(",").map(Number));
  for (const [x, y] of ends) pen.lineTo(x, y);
  pen.stroke();
}
