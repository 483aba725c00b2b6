import { make } from "../../dom/elements";
import type { SessionController } from "../../session/session_controller";
import { t } from "../../language/translate";

/** The number of pulled vertices, by any viewer, and a button to release them; hidden if there are none. */
export function pullRow(controller: SessionController): HTMLElement {
  const words = make("span");
  const letGo = make(
    "button",
    { type: "button", id: "release-pulls", onclick: () => void controller.releasePulls() },
    t("Release"),
  );
  const row = make("div", { className: "pull-row", id: "pulls", hidden: true }, words, letGo);
  controller.session.subscribe((session) => {
    const pulls = session?.pulls ?? [];
    row.hidden = pulls.length === 0;
    words.textContent = pulls.length === 1 ? t("One vertex is pulled") : t("{0} vertices are pulled", pulls.length);
  });
  return row;
}
