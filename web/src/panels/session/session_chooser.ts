import { type Api, errorText } from "../../connection/api";
import { make } from "../../dom/elements";
import { type SceneSummary, type Session, SessionState } from "../../gen/phrenic/v1/session_pb";
import { t } from "../../language/translate";

/** A dialog that opens a running session or starts a session of any scene in the server's catalogue. */
export class SessionChooser {
  readonly element = make("dialog", { className: "chooser", ariaLabel: t("Sessions and scenes") });
  private readonly sessions = make("ul");
  private readonly scenes = make("ul");
  private readonly words = make("p", { className: "fault" });

  constructor(
    private readonly api: Api,
    private readonly open: (sessionId: string) => void,
    /** Opens the dialogs that make a body and a patient. */
    chooseBody: () => void,
    importPatient: () => void,
  ) {
    const close = make("button", { type: "button", onclick: () => this.element.close() }, t("Close"));
    const leadTo = (id: string, words: string, next: () => void) => {
      const onclick = () => (this.element.close(), next());
      return make("button", { type: "button", id, onclick }, words);
    };
    this.words.setAttribute("role", "alert");
    this.element.append(
      make("header", {}, make("h2", {}, t("Sessions")), close),
      this.sessions,
      make("h2", {}, t("Start a session of")),
      this.scenes,
      make(
        "div",
        { className: "acts" },
        leadTo("body-new", t("A body by sex, age and size"), chooseBody),
        leadTo("patient-new", t("A patient from a segmentation"), importPatient),
      ),
      this.words,
    );
  }

  /** Opens the dialog and loads sessions and scenes. */
  async show(): Promise<void> {
    this.words.textContent = "";
    if (!this.element.open) this.element.showModal();
    try {
      const [{ sessions }, { scenes }] = await Promise.all([
        this.api.sessions.listSessions({}),
        this.api.scenes.listScenes({}),
      ]);
      this.sessions.replaceChildren(...sessions.map((session) => this.sessionRow(session)));
      // Scenes with several presets come first.
      const sorted = scenes.toSorted((a, b) => b.presets.length - a.presets.length);
      this.scenes.replaceChildren(...sorted.map((scene) => this.sceneRow(scene)));
    } catch (error) {
      this.words.textContent = errorText(error);
    }
  }

  private sessionRow({ id, scene, sceneTitle, state, viewers }: Session): HTMLElement {
    const words =
      state === SessionState.PLAYING ? t("playing") : state === SessionState.DIVERGED ? t("diverged") : t("paused");
    const detail = `${id}, ${words}, ${viewers === 1 ? t("1 viewer") : t("{0} viewers", viewers)}`;
    return this.row(t(sceneTitle) || scene, detail, t("Open"), async () => this.open(id));
  }

  private sceneRow({ name, title, description }: SceneSummary): HTMLElement {
    const row = this.row(t(title) || name, t(description), t("Start"), () => this.start(name));
    row.dataset.scene = name;
    return row;
  }

  private row(title: string, detail: string, verb: string, act: () => Promise<void>): HTMLElement {
    const words = make("div", {}, make("b", {}, title), make("span", {}, detail));
    const go = make("button", { type: "button", ariaLabel: `${verb}: ${title}` }, verb);
    go.onclick = async () => {
      go.disabled = true;
      await act();
      go.disabled = false;
    };
    return make("li", {}, words, go);
  }

  private async start(name: string): Promise<void> {
    this.words.textContent = t("Compiling the scene…");
    try {
      const { session } = await this.api.sessions.createSession({ source: { source: { case: "name", value: name } } });
      const sessionId = session?.id ?? "";
      await this.api.sessions.playSession({ sessionId });
      this.open(sessionId);
    } catch (error) {
      this.words.textContent = errorText(error);
    }
  }
}
