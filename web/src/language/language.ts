import { type Messages, t, useMessages } from "./translate";

/** The languages of the page, by their names in themselves. The texts of the sources are English. */
export const languages = { en: "English", de: "Deutsch", es: "Español" };

/** A language of the page. */
export type Language = keyof typeof languages;

/** A language, and the tag of the browser's preference that chose it: "de-AT" for German. */
export interface LanguageChoice {
  language: Language;
  tag: string;
}

const key = "phrenic-language";

const known = (name: string | null): name is Language => name !== null && Object.hasOwn(languages, name);

/**
 * Returns the language of a page: the one that its address names ("lang=de"), else the one that this browser chose
 * last, else the first of the browser's preferences that the page has, else English.
 */
export function languageOf(
  address: URL,
  storage: Pick<Storage, "getItem">,
  preferences: readonly string[],
): LanguageChoice {
  const base = (tag: string) => tag.toLowerCase().split("-")[0];
  const chosen = [address.searchParams.get("lang"), storage.getItem(key)].find(known);
  const language = chosen ?? preferences.map(base).find(known) ?? "en";
  return { language, tag: preferences.find((tag) => base(tag) === language) ?? language };
}

/** Remembers the language for the next page of this browser. */
export function rememberLanguage(language: Language, storage: Pick<Storage, "setItem">): void {
  storage.setItem(key, language);
}

/** Fetches the JSON of a path. */
type Fetch = (path: string) => Promise<unknown>;

let page: Language = "en";

/** Returns the language that the page has. */
export function pageLanguage(): Language {
  return page;
}

/**
 * Sets the language of the page and translates what its HTML says. English needs no file; a language whose file cannot
 * be loaded leaves the page in English.
 */
export async function openLanguage({ language, tag }: LanguageChoice, fetchFile: Fetch): Promise<void> {
  if (language === "en") return;
  const messages = await fetchFile(`languages/${language}.json`).catch(() => undefined);
  if (messages !== undefined) applyMessages(messages as Messages, language, tag);
}

/** Sets the language of the page by its messages, and translates what its HTML says. */
export function applyMessages(messages: Messages, language: Language, tag: string): void {
  page = language;
  useMessages(messages, tag);
  document.documentElement.lang = language;
  translateElements(document.documentElement);
}

const attributes = ["title", "aria-label"];

/** Translates the texts and the spoken attributes of elements that the HTML of the page has. */
function translateElements(root: Element): void {
  for (const element of root.querySelectorAll("*")) {
    for (const name of attributes) {
      const value = element.getAttribute(name);
      if (value !== null) element.setAttribute(name, t(value));
    }
    for (const node of element.childNodes) {
      const text = node.nodeType === Node.TEXT_NODE ? (node.nodeValue ?? "").trim() : "";
      if (text !== "") node.nodeValue = (node.nodeValue ?? "").replace(text, () => t(text));
    }
  }
}
