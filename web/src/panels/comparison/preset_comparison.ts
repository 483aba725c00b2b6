import { make } from "../../dom/elements";
import type { Preset } from "../../gen/phrenic/v1/scene_pb";
import { labelOf, presetOf } from "../../parameters/presets";
import type { Controller } from "../../session/session_controller";
import type { Signal } from "../../state/signal";

/**
 * A list of the scene's ways to breathe: the chosen one is shown beside this session, in a copy of it from the present
 * instant. Where there are two pictures already, it is the second one's.
 */
export function compareWith(
  controller: Controller,
  presets: Signal<Preset[]>,
  open: (query: string) => void,
): HTMLElement {
  const list = make("select", { id: "compare-with", title: "Opens a second picture that breathes this way" });
  const label = make("label", { htmlFor: "compare-with" }, "Compare with");
  const row = make("div", { className: "compare-row", id: "compare-with-row" }, label, list);
  const { companion, sessionId } = controller;
  list.onchange = async () => {
    if (companion !== undefined) return companion.usePreset(list.value);
    list.disabled = true;
    const beside = await controller.forkBeside(list.value);
    list.disabled = false;
    if (beside !== undefined) open(`?${new URLSearchParams({ session: sessionId, beside })}`);
    list.value = "";
  };
  const mark = () => {
    list.value = presetOf(presets.value, companion?.session.value?.parameters)?.name ?? "";
  };
  presets.subscribe((all) => {
    row.hidden = all.length === 0;
    const none = make("option", { value: "", disabled: true }, companion === undefined ? "Choose…" : "As it is set");
    list.replaceChildren(
      none,
      ...all.map((each) => make("option", { value: each.name, title: each.title }, labelOf(each))),
    );
    mark();
  });
  companion?.session.subscribe(mark);
  return row;
}
