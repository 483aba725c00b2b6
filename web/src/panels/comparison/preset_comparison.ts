import { make } from "../../dom/elements";
import { labelledRow } from "../../dom/rows";
import type { Preset } from "../../gen/phrenic/v1/scene_pb";
import { activePreset, presetGroups, presetLabel } from "../../parameters/presets";
import type { SessionController } from "../../session/session_controller";
import type { Signal } from "../../state/signal";
import { t } from "../../language/translate";

/**
 * A list of the scene's presets. Selecting one opens a copy of the session with this preset in a second view, or sets
 * the preset of the second view if there is one.
 */
export function presetComparison(
  controller: SessionController,
  presets: Signal<Preset[]>,
  open: (query: string) => void,
): HTMLElement {
  const list = make("select", { id: "compare-with", title: t("Opens a second view with this preset") });
  const row = labelledRow("compare-with", t("Compare with"), list);
  row.id = "compare-with-row";
  const { companion, sessionId } = controller;
  list.onchange = async () => {
    if (companion !== undefined) return companion.usePreset(list.value);
    list.disabled = true;
    const secondSessionId = await controller.forkForComparison(list.value);
    list.disabled = false;
    if (secondSessionId !== undefined) open(`?${new URLSearchParams({ session: sessionId, beside: secondSessionId })}`);
    list.value = "";
  };
  const mark = () => {
    list.value = activePreset(presets.value, companion?.session.value?.parameters)?.name ?? "";
  };
  presets.subscribe((all) => {
    row.hidden = all.length === 0;
    const none = make("option", { value: "", disabled: true }, companion === undefined ? t("Choose…") : t("Custom"));
    list.replaceChildren(none, ...[...presetGroups(all)].flatMap(([name, members]) => presetOptions(name, members)));
    mark();
  });
  companion?.session.subscribe(mark);
  return row;
}

/** The options of a group of presets, below its name unless that is empty. */
function presetOptions(group: string, members: Preset[]): HTMLElement[] {
  const options = members.map((each) =>
    make("option", { value: each.name, title: t(each.description) }, presetLabel(each)),
  );
  return group === "" ? options : [make("optgroup", { label: t(group) }, ...options)];
}
