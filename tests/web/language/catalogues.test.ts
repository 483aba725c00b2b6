import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fromJsonString } from "@bufbuild/protobuf";
import { afterEach, describe, expect, test } from "vitest";
import { LessonSchema } from "../../../web/src/gen/phrenic/v1/lesson_pb";
import { applyMessages, languageOf, languages } from "../../../web/src/language/language";
import { decimal, fixed, lower, type Messages, t, useMessages } from "../../../web/src/language/translate";
import { textsOf, withWords } from "../../../web/src/session/lesson_words";
import { keysOfSources } from "./keys";

const folder = join(import.meta.dirname, "../../../web/public");
const read = (path: string) => JSON.parse(readFileSync(join(folder, path), "utf8")) as Messages;
const lessons = read("lessons/index.json") as unknown as string[];
const lessonOf = (name: string) =>
  fromJsonString(LessonSchema, readFileSync(join(folder, `lessons/${name}.json`), "utf8"));
const keys = keysOfSources();

const placeholders = (text: string) => [...text.matchAll(/\{\w+\}/g)].map(([each]) => each).sort();
/** The numbers of a text, with a decimal point. */
const numbers = (text: string) => [...text.matchAll(/\d+(?:[.,]\d+)?/g)].map(([each]) => each.replace(",", ".")).sort();
/** Words that {side}, {ordinal} and the like stand for differ from one language to another. */
const isName = (text: string) => /\{[a-zA-Z]\w+\}/.test(text);

afterEach(() => useMessages({}, "en"));

test("TheLanguagesAreThoseOfTheFiles", () => {
  const files = readdirSync(join(folder, "languages")).filter((name) => name.endsWith(".json"));
  expect(["en", ...files.map((name) => name.replace(".json", ""))].sort()).toEqual(Object.keys(languages).sort());
});

describe.each(Object.keys(languages).filter((name) => name !== "en"))("the catalogue %s", (language) => {
  const catalogue = read(`languages/${language}.json`);

  test("HasEveryTextOfTheSourcesAndNoOther", () => {
    expect([...keys].filter((key) => !Object.hasOwn(catalogue, key))).toEqual([]);
    expect(Object.keys(catalogue).filter((key) => !keys.has(key))).toEqual([]);
  });

  test("KeepsPlaceholdersAndSpacesAtTheEnds", () => {
    for (const [key, text] of Object.entries(catalogue)) {
      expect(text.trim(), key).not.toBe("");
      if (!isName(key)) expect(placeholders(text), key).toEqual(placeholders(key));
      expect([/^ /.test(text), / $/.test(text)], key).toEqual([/^ /.test(key), / $/.test(key)]);
    }
  });

  test("KnowsThePlaceholdersOfNames", () => {
    const names = Object.entries(catalogue).filter(([key]) => isName(key));
    expect(names.length).toBeGreaterThan(5);
    for (const [key, text] of names)
      for (const each of placeholders(text)) expect(["{number}", "{side}"], key).toContain(each);
  });

  test.each(lessons)("HasTheWordsAndTheNumbersOfTheLesson %s", (name) => {
    const words = read(`languages/${language}/${name}.json`);
    const lesson = lessonOf(name);
    expect(Object.keys(words).sort()).toEqual(textsOf(lesson).sort());
    for (const [key, text] of Object.entries(words)) expect(numbers(text), key).toEqual(numbers(key));
    expect(textsOf(withWords(lesson, words))).not.toContain(lesson.steps[0].caption);
  });
});

test("ATextIsFilledAndStaysEnglishWithoutATranslation", () => {
  expect(t("Step {0} of {1}", 2, 5)).toBe("Step 2 of 5");
  useMessages({ "Step {0} of {1}": "Von {1} der Schritt {0}" }, "de-AT");
  expect(t("Step {0} of {1}", 2, 5)).toBe("Von 5 der Schritt 2");
  expect(t("Unknown {0}", 1)).toBe("Unknown 1");
});

test("NumbersHaveTheDecimalSignOfTheLanguage", () => {
  expect([fixed(0.5, 2), decimal("1.5"), lower("Rib")]).toEqual(["0.50", "1.5", "rib"]);
  useMessages({}, "de");
  expect([fixed(0.5, 2), decimal("1.5"), lower("Rippe")]).toEqual(["0,50", "1,5", "Rippe"]);
  useMessages({}, "es-MX");
  expect(fixed(-0.5, 1)).toBe("-0.5");
});

test("TheLanguageIsThatOfTheAddressThenTheLastChoiceThenThatOfTheBrowser", () => {
  const storage = (kept: string | null) => ({ getItem: () => kept });
  const choice = (query: string, kept: string | null, preferences: string[]) =>
    languageOf(new URL(`http://host/${query}`), storage(kept), preferences);
  expect(choice("?lang=es", "de", ["de"])).toEqual({ language: "es", tag: "es" });
  expect(choice("", "de", ["es"]).language).toBe("de");
  expect(choice("", null, ["fr", "es-MX", "de"])).toEqual({ language: "es", tag: "es-MX" });
  expect(choice("?lang=toString", null, ["fr"]).language).toBe("en");
  expect(choice("", "nonsense", []).language).toBe("en");
});

test("ThePageIsTranslatedWithItsLanguage", () => {
  document.body.innerHTML = `<button title="Share">Graphs <b>Live</b></button><p>Other</p>`;
  applyMessages({ Share: "Teilen", Graphs: "Kurven", Live: "Jetzt" }, "de", "de");
  expect(document.documentElement.lang).toBe("de");
  expect(document.body.innerHTML).toBe(`<button title="Teilen">Kurven <b>Jetzt</b></button><p>Other</p>`);
});
