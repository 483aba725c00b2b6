import type { Structure } from "../../anatomy/structures";
import { make } from "../../dom/elements";
import { t } from "../../language/translate";

/** What the search field searches, and what it does with a result. */
export interface StructureSearch {
  search(text: string): Structure[];
  choose(structure: Structure): void;
  /** Called by the Escape key in an empty field. */
  leave(): void;
}

/** A field that finds a structure by a part of its English or Latin name; the arrow keys go through the results. */
export function structureSearch({ search, choose, leave }: StructureSearch): HTMLElement {
  const list = make("ul", { id: "find-results", role: "listbox", ariaLabel: t("Structures"), hidden: true });
  const field = make("input", {
    type: "search",
    id: "find-structure",
    role: "combobox",
    placeholder: t("Find a structure"),
    ariaLabel: t("Find a structure"),
    title: t("Name it in English or Latin (/)"),
    ariaExpanded: "false",
    ariaAutoComplete: "list",
    autocomplete: "off",
    spellcheck: false,
  });
  field.setAttribute("aria-controls", list.id);
  let found: Structure[] = [];
  let active = 0;
  const show = () => {
    list.replaceChildren(...found.map((structure, i) => option(structure, i, i === active, () => take(structure))));
    list.hidden = found.length === 0;
    field.ariaExpanded = String(found.length > 0);
    if (found.length > 0) field.setAttribute("aria-activedescendant", `found-${active}`);
    else field.removeAttribute("aria-activedescendant");
    list.children[active]?.scrollIntoView?.({ block: "nearest" });
  };
  const find = (results: Structure[]) => {
    [found, active] = [results, 0];
    show();
  };
  const take = (structure: Structure) => {
    field.value = structure.name;
    find([]);
    choose(structure);
  };
  const move = (by: number) => {
    if (found.length === 0) return find(search(field.value));
    active = (active + by + found.length) % found.length;
    show();
  };
  field.oninput = () => find(search(field.value));
  field.onfocus = () => field.select();
  field.onblur = () => find([]);
  field.onkeydown = (event) => {
    const first = found.length > 0 ? found[active] : search(field.value)[0];
    if (event.key === "ArrowDown") move(1);
    else if (event.key === "ArrowUp") move(-1);
    else if (event.key === "Enter" && first !== undefined) take(first);
    else if (event.key === "Escape") {
      if (found.length === 0) leave();
      field.value = "";
      find([]);
    } else return;
    event.preventDefault();
  };
  return make("div", { id: "find" }, field, list);
}

function option({ name, latin }: Structure, index: number, selected: boolean, take: () => void): HTMLElement {
  const words = [make("span", {}, name), make("span", { className: "latin", lang: "la" }, latin)];
  const item = make("li", { id: `found-${index}`, role: "option", ariaSelected: String(selected) }, ...words);
  // Before the field loses the focus, which closes the list.
  item.onpointerdown = (event) => {
    event.preventDefault();
    take();
  };
  return item;
}
