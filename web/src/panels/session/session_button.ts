import { make } from "../../dom/elements";
import type { SessionController } from "../../session/session_controller";
import { t } from "../../language/translate";

/** A button with the title of the scene and the session id that opens the session chooser. */
export function sessionButton(controller: SessionController, open: () => void): HTMLElement {
  const title = make("b");
  const id = make("span");
  controller.session.subscribe((session) => {
    title.textContent = t(session?.sceneTitle ?? "") || session?.scene || "";
    id.textContent = session?.id ?? "";
  });
  return make("button", { type: "button", id: "session", title: t("Sessions and scenes"), onclick: open }, title, id);
}
