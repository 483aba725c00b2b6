import { make } from "../../dom/elements";
import { type Language, languages, pageLanguage, rememberLanguage } from "../../language/language";
import { t } from "../../language/translate";

/** A list of the page's languages. A choice is remembered by the browser, and `open` loads the page again with it. */
export function languageMenu(storage: Pick<Storage, "setItem">, open: (query: string) => void): HTMLElement {
  const list = make("select", { id: "language", ariaLabel: t("Language"), title: t("Language") });
  for (const [value, name] of Object.entries(languages))
    list.append(
      make("option", { value, lang: value, ariaLabel: name, selected: value === pageLanguage() }, value.toUpperCase()),
    );
  list.onchange = () => {
    rememberLanguage(list.value as Language, storage);
    const query = new URLSearchParams(location.search);
    query.delete("lang");
    open(`?${query}`);
  };
  return list;
}
