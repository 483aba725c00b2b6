import { describe, expect, test } from "vitest";
import { animationSize, filmLayout, filmLines, filmRate, filmSize, filmTimes } from "../../../web/src/film/layout";

const views = [
  [1440, 900],
  [883, 517],
  [360, 401],
  [3840, 600],
  [1, 1],
];
const sizes = [...filmLines.map(filmSize), animationSize];

describe("the layout of a film", () => {
  test.each(views.flatMap(([width, height]) => sizes.map((most) => [width, height, most] as const)))(
    "OfAViewOf%dx%dIsEvenAndKeepsTheShapeIn%o",
    (width, height, most) => {
      const film = filmLayout(width, height, most);
      expect([film.width % 2, film.height % 2, film.pictureHeight % 2]).toEqual([0, 0, 0]);
      expect(film.width).toBeLessThanOrEqual(most.width);
      expect(film.height).toBeLessThanOrEqual(most.height);
      expect(film.height - film.pictureHeight).toBeCloseTo(64 * film.captionScale, 9);
      expect(Math.abs(film.width - width * film.scale)).toBeLessThan(2);
      expect(Math.abs(film.pictureHeight - height * film.scale)).toBeLessThan(2);
      expect(film.width > most.width - 4 || film.height > most.height - 4).toBe(true);
    },
  );

  test("HasACaptionThatCanBeReadInEachSize", () => {
    const scales = sizes.map((most) => filmLayout(883, 517, most).captionScale);
    expect(scales).toEqual([0.75, 1, 1.5, 0.75]);
  });
});

describe("the times of a film", () => {
  test("AreEquallySpacedAndEndBeforeTheNextBreath", () => {
    const times = filmTimes(4);
    expect(times.length).toBe(4 * filmRate);
    expect(times[0]).toBe(0);
    for (let i = 1; i < times.length; i++) expect(times[i] - times[i - 1]).toBeCloseTo(1 / filmRate, 9);
    expect(times[times.length - 1] + 1 / filmRate).toBeCloseTo(4, 9);
  });

  test("NeverLieOutsideOfTheMotion", () => {
    for (const length of [0, 0.01, 0.99, 3.333]) {
      const times = filmTimes(length);
      expect(times.length).toBeGreaterThan(0);
      expect(Math.max(...times)).toBeLessThanOrEqual(length);
    }
  });
});
