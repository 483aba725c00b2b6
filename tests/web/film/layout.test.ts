import { describe, expect, test } from "vitest";
import { captionHeight, filmLayout, filmRate, filmTimes } from "../../../web/src/film/layout";

describe("the layout of a film", () => {
  test.each([
    [1440, 900],
    [883, 517],
    [360, 401],
    [3840, 600],
    [1, 1],
  ])("OfAViewOf%dx%dIsEvenAndKeepsTheShape", (width, height) => {
    const film = filmLayout(width, height);
    expect([film.width % 2, film.height % 2]).toEqual([0, 0]);
    expect(film.width).toBeLessThanOrEqual(1280);
    expect(film.height).toBeLessThanOrEqual(720);
    expect(film.pictureHeight).toBe(film.height - captionHeight);
    expect(Math.abs(film.width - width * film.scale)).toBeLessThan(2);
    expect(Math.abs(film.pictureHeight - height * film.scale)).toBeLessThan(2);
    expect(film.width > 1276 || film.height > 716).toBe(true);
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
