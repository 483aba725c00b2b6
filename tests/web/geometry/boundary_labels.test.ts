import { describe, expect, test } from "vitest";
import { type LabelAnchor, type LabelFrame, linesCross, placeLabels } from "../../../web/src/geometry/boundary_labels";

/** Returns numbers from 0 to 1 that depend on the seed alone (mulberry32). */
function randomNumbers(seed: number): () => number {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

interface Case {
  anchors: LabelAnchor[];
  frame: LabelFrame;
  spacing: number;
}

/** Points within and around a frame: spread, in a few clusters, or on a grid with equal coordinates. */
function randomCase(seed: number): Case {
  const random = randomNumbers(seed);
  const between = (low: number, high: number) => low + (high - low) * random();
  const [left, top] = [between(0, 300), between(0, 100)];
  const frame = { left, right: left + between(40, 700), top, bottom: top + between(10, 700) };
  const kind = seed % 3;
  const centres = Array.from({ length: 3 }, () => [between(left, frame.right), between(top, frame.bottom)]);
  const anchors = Array.from({ length: Math.floor(between(0, 70)) }, (_, i) => {
    const [cx, cy] = centres[i % 3];
    const spread = [between(left - 30, frame.right + 30), between(top - 30, frame.bottom + 30)];
    const [x, y] = [spread, [cx + between(-20, 20), cy + between(-20, 20)], spread.map((v) => 40 * Math.round(v / 40))][
      kind
    ];
    return { x, y, weight: Math.floor(between(1, 20)) };
  });
  return { anchors, frame, spacing: between(12, 40) };
}

const cases = Array.from({ length: 600 }, (_, seed) => randomCase(seed));

describe("labels of random points", () => {
  test("DoNotOverlap", () => {
    for (const { anchors, frame, spacing } of cases) {
      const places = placeLabels(anchors, frame, spacing);
      for (const side of ["left", "right"]) {
        const heights = places.flatMap((place) => (place?.side === side ? [place.y] : [])).sort((a, b) => a - b);
        for (let i = 1; i < heights.length; i++)
          expect(heights[i] - heights[i - 1]).toBeGreaterThan(spacing * (1 - 1e-9));
      }
    }
  });

  test("AreInsideTheFrame", () => {
    for (const { anchors, frame, spacing } of cases) {
      for (const place of placeLabels(anchors, frame, spacing)) {
        if (place === undefined) continue;
        expect(place.y).toBeGreaterThan(frame.top + spacing / 2 - 1e-6);
        expect(place.y).toBeLessThan(frame.bottom - spacing / 2 + 1e-6);
        expect(place.x).toBe(frame[place.side]);
      }
    }
  });

  test("HaveLinesThatDoNotCross", () => {
    let lines = 0;
    for (const { anchors, frame, spacing } of cases) {
      const placed = placeLabels(anchors, frame, spacing).flatMap((to, i) => (to ? [{ from: anchors[i], to }] : []));
      lines += placed.length;
      placed.forEach((a, i) => {
        for (const b of placed.slice(i + 1)) expect(linesCross(a.from, a.to, b.from, b.to)).toBe(false);
      });
    }
    expect(lines).toBeGreaterThan(5000);
  });

  test("AreAsManyAsFitTheHeaviestFirst", () => {
    for (const { anchors, frame, spacing } of cases) {
      const places = placeLabels(anchors, frame, spacing);
      const within = anchors.map(({ x }) => x >= frame.left && x <= frame.right);
      const room = 2 * Math.floor((frame.bottom - frame.top) / spacing);
      const count = places.filter((place) => place !== undefined).length;
      expect(count).toBe(Math.min(room, within.filter(Boolean).length));
      const least = Math.min(...anchors.flatMap(({ weight }, i) => (places[i] ? [weight] : [])));
      anchors.forEach(({ weight }, i) => {
        if (within[i] && places[i] === undefined) expect(weight).toBeLessThanOrEqual(least);
        if (!within[i]) expect(places[i]).toBeUndefined();
      });
    }
  });
});

const frame = { left: 0, right: 100, top: 0, bottom: 100 };

test("ALabelWithRoomIsAtTheHeightOfItsPointOnItsSide", () => {
  const anchors = [{ x: 20, y: 40, weight: 1 }, { x: 70, y: 60, weight: 1 }]; // prettier-ignore
  expect(placeLabels(anchors, frame, 10)).toEqual([
    { side: "left", x: 0, y: 40 },
    { side: "right", x: 100, y: 60 },
  ]);
});

test("AFullSidePassesItsPointsNearestToTheMiddleOver", () => {
  const anchors = [10, 20, 30, 40].map((x) => ({ x, y: 50, weight: 1 }));
  expect(placeLabels(anchors, frame, 40).map((place) => place?.side)).toEqual(["left", "left", "right", "right"]);
});

test("AFrameWithoutRoomHasNoLabels", () => {
  expect(placeLabels([{ x: 50, y: 5, weight: 1 }], { ...frame, bottom: 9 }, 10)).toEqual([undefined]);
});

test("LinesThatTouchDoNotCross", () => {
  const [a, b, c] = [{ x: 0, y: 0 }, { x: 2, y: 2 }, { x: 2, y: 0 }]; // prettier-ignore
  expect(linesCross(a, b, c, { x: 0, y: 2 })).toBe(true);
  expect(linesCross(a, b, c, { x: 1, y: 1 })).toBe(false);
  expect(linesCross(a, b, a, c)).toBe(false);
});
