import { download } from "../../dom/download";
import { make } from "../../dom/elements";
import { type Study, StudyState } from "../../gen/phrenic/v1/study_pb";
import type { SessionController } from "../../session/session_controller";
import { isFinished, Studies, type StudyKind } from "../../session/studies";
import { t } from "../../language/translate";

export { Studies };

const kinds: [StudyKind, string, string][] = [
  [
    "error",
    "Error against run time",
    "All integrators with a series of time steps, compared with an independent reference",
  ],
  ["stability", "Stability", "A map over stiffness and time step, and a suite of extreme cases"],
  ["cost", "Cost", "Cost of each part of the scene, and what omitting it saves"],
  ["streaming", "Error against bandwidth", "Bandwidth and error of every codec and error bound"],
];

/** Fills a section that starts, lists, cancels and shows studies of the session's scene with its current parameters. */
export function fillStudies(panel: HTMLDetailsElement, studies: Studies, controller: SessionController): void {
  const kind = make("select", { id: "study-kind" });
  kind.append(...kinds.map(([value, label, title]) => make("option", { value, title: t(title) }, t(label))));
  const start = make("button", { type: "button", id: "study-start" }, t("Start"));
  start.onclick = () => {
    const session = controller.session.value;
    if (session !== undefined) void studies.start(kind.value as StudyKind, session.scene, session.parameters);
  };
  const fault = make("p", { className: "fault", id: "study-fault" });
  fault.setAttribute("role", "alert");
  studies.errorMessage.subscribe((words) => (fault.textContent = words));
  const list = make("div", { className: "studies", id: "studies" });
  const view = new StudyView();
  studies.all.subscribe((all) => list.replaceChildren(...all.map((study) => studyRow(study, studies, view)).reverse()));
  const hint = make(
    "p",
    { className: "faint" },
    t("Studies of this scene with its current parameters. One study runs at a time."),
  );
  const row = make("div", { className: "study-start" }, kind, start);
  kind.ariaLabel = t("Study");
  panel.append(row, hint, fault, list, view.element);
  panel.ontoggle = () => {
    if (panel.open) void studies.load();
  };
  void studies.load();
}

function studyRow(study: Study, studies: Studies, view: StudyView): HTMLElement {
  const { id, doing, state, problem } = study;
  const words = make("div", { className: "words" }, make("b", {}, id), make("span", { className: "faint" }));
  const stateLabel = words.lastElementChild as HTMLElement;
  stateLabel.textContent =
    state === StudyState.FAILED
      ? problem
      : state === StudyState.DONE
        ? t("done")
        : state === StudyState.QUEUED
          ? t("waiting")
          : doing;
  const buttons = make("div", { className: "row" });
  if (state === StudyState.DONE) buttons.append(...doneButtons(study, studies, view));
  const remove = make("button", { type: "button", className: "small" }, isFinished(study) ? t("Delete") : t("Cancel"));
  remove.ariaLabel = `${remove.textContent} ${id}`;
  remove.onclick = () => void studies.remove(id);
  buttons.append(remove);
  const bar = make("progress", { max: 1, value: study.progress, ariaLabel: t("Progress of {0}", id) });
  const row = make("div", { className: "study" }, words, buttons, ...(isFinished(study) ? [] : [bar]));
  row.dataset.study = id;
  return row;
}

function doneButtons({ id }: Study, studies: Studies, view: StudyView): HTMLElement[] {
  const open = make("button", { type: "button", className: "small", ariaLabel: t("Open {0}", id) }, t("Open"));
  open.onclick = async () => view.show(await studies.result(id));
  const save = make("button", { type: "button", className: "small", ariaLabel: t("Save {0}", id) }, t("Save"));
  save.onclick = async () => download(`${id}.html`, new Blob([await studies.page(id)], { type: "text/html" }));
  return [open, save];
}

/** A dialog that shows a study. */
class StudyView {
  readonly element = make("dialog", { className: "study-view", ariaLabel: t("Study") });
  private readonly paper = make("div");

  constructor() {
    const close = make("button", { type: "button", onclick: () => this.element.close() }, t("Close"));
    this.element.append(make("header", {}, close), this.paper);
  }

  async show(study: Study | undefined): Promise<void> {
    if (study === undefined) return;
    // The plotting code is loaded when the first study is opened.
    const { embed } = await import("../../report/embedded");
    embed(this.paper, study);
    this.element.showModal();
  }
}
