import { describe, expect, test, vi } from "vitest";
import type { Structure } from "../../../../web/src/anatomy/structures";
import { structureCard } from "../../../../web/src/panels/view/structure_card";
import { structureSearch } from "../../../../web/src/panels/view/structure_search";
import { Signal } from "../../../../web/src/state/signal";

const structure = (name: string): Structure => ({
  body: name,
  region: "",
  name,
  latin: "Costa",
  also: "",
  definition: `${name} is defined.`,
  vertices: undefined,
});
const [first, second] = [structure("First rib"), structure("Second rib")];

describe("the search for a structure", () => {
  const setUp = () => {
    const [choose, leave] = [vi.fn(), vi.fn()];
    const search = (text: string) => (text === "rib" ? [first, second] : []);
    const element = structureSearch({ search, choose, leave });
    document.body.replaceChildren(element);
    const field = element.querySelector("input")!;
    const type = (text: string) => {
      field.value = text;
      field.dispatchEvent(new Event("input"));
    };
    const press = (key: string) => field.dispatchEvent(new KeyboardEvent("keydown", { key, cancelable: true }));
    const options = () => [...element.querySelectorAll('[role="option"]')];
    return { choose, leave, field, type, press, options };
  };

  test("ListsWhatIsFoundAndTellsScreenReaders", () => {
    const { field, type, options } = setUp();
    type("rib");
    expect(options().map((each) => each.firstChild?.textContent)).toEqual(["First rib", "Second rib"]);
    expect(field.getAttribute("aria-activedescendant")).toBe(options()[0].id);
    type("none");
    expect(options()).toEqual([]);
    expect(field.hasAttribute("aria-activedescendant")).toBe(false);
  });

  test("ChoosesByTheKeyboard", () => {
    const { choose, type, press, options } = setUp();
    type("rib");
    press("ArrowDown");
    press("Enter");
    expect(choose).toHaveBeenCalledWith(second);
    expect(options()).toEqual([]);
  });

  test("ChoosesByThePointer", () => {
    const { choose, type, options } = setUp();
    type("rib");
    options()[0].dispatchEvent(new Event("pointerdown"));
    expect(choose).toHaveBeenCalledWith(first);
  });

  test("LeavesByASecondEscape", () => {
    const { leave, type, press } = setUp();
    type("rib");
    press("Escape");
    expect(leave).not.toHaveBeenCalled();
    press("Escape");
    expect(leave).toHaveBeenCalledOnce();
  });
});

test("TheCardDefinesTheChosenStructureAndShowsItAlone", () => {
  const chosen = new Signal<Structure | undefined>(undefined);
  const isolated = new Signal<Structure | undefined>(undefined);
  const actions = { isolate: vi.fn(), showAll: vi.fn() };
  const card = structureCard(chosen, isolated, actions);
  expect(card.hidden).toBe(true);
  chosen.set(first);
  expect(card.hidden).toBe(false);
  expect(card.textContent).toContain("First rib is defined.");
  const alone = card.querySelector<HTMLButtonElement>("#structure-alone")!;
  alone.click();
  expect(actions.isolate).toHaveBeenCalledWith(first);
  isolated.set(first);
  alone.click();
  expect(actions.showAll).toHaveBeenCalledOnce();
});
