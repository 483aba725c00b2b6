import { expect, test } from "vitest";
import { lessonPlaceOf, withLessonPlace } from "../../../web/src/session/lessons";
import { pageViewOf, rememberPageView, withPageView } from "../../../web/src/session/page_view";

function memory() {
  const values = new Map<string, string>();
  return {
    getItem: (key: string) => values.get(key) ?? null,
    setItem: (key: string, value: string) => void values.set(key, value),
  };
}

const page = (rest: string) => new URL(`http://phrenic/${rest}`);

test("TheAddressDecidesThenTheBrowsersMemory", () => {
  const storage = memory();
  expect(pageViewOf(page("?session=a"), storage)).toBe("expert");
  rememberPageView("student", storage);
  expect(pageViewOf(page("?session=a"), storage)).toBe("student");
  expect(pageViewOf(page("?session=a&view=expert"), storage)).toBe("expert");
});

test("AClassLinkAndALessonOpenTheStudentView", () => {
  expect(pageViewOf(page("?session=a#join=0123"), memory())).toBe("student");
  expect(pageViewOf(page("?session=a&lesson=copd"), memory())).toBe("student");
});

test("TheViewIsAlwaysNamed", () => {
  expect(withPageView("?session=a", "student")).toBe("?session=a&view=student");
  expect(withPageView("?session=a&view=student", "expert")).toBe("?session=a&view=expert");
});

test("TheExpertViewOfAnAddressOutlastsTheMemoryOfTheStudentView", () => {
  const storage = memory();
  rememberPageView("student", storage);
  expect(pageViewOf(page(withPageView("?session=a&lesson=copd", "expert")), storage)).toBe("expert");
});

test("ALessonAndItsStepAreInTheAddress", () => {
  expect(lessonPlaceOf(page("?lesson=copd&step=3"))).toEqual({ name: "copd", step: 3 });
  expect(lessonPlaceOf(page("?lesson=copd&step=-2"))).toEqual({ name: "copd", step: 1 });
  expect(lessonPlaceOf(page("?session=a"))).toBeUndefined();
  expect(withLessonPlace("?session=a", { name: "copd", step: 2 })).toBe("?session=a&lesson=copd&step=2");
  expect(withLessonPlace("?session=a&lesson=copd&step=2", undefined)).toBe("?session=a");
});
