import { switchRow } from "../../dom/rows";
import { ownStorage } from "../../dom/storage";
import { t } from "../../language/translate";

const key = "phrenic-projector";

/** A switch for large type and strong contrast, stored in the browser. */
export function projectorRow(memory: Pick<Storage, "getItem" | "setItem"> = ownStorage): HTMLElement {
  const turn = (on: boolean) => {
    document.documentElement.classList.toggle("projector", on);
    memory.setItem(key, on ? "on" : "off");
  };
  const { row, input } = switchRow(t("Projector mode"), t("Large type and strong contrast."), turn);
  input.id = "projector";
  input.checked = memory.getItem(key) === "on";
  turn(input.checked);
  return row;
}
