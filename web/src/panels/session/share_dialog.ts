import { make } from "../../dom/elements";
import type { CompileReport } from "../../gen/phrenic/v1/report_pb";
import type { KeptMeasurement } from "../../geometry/measuring";
import { withMeasurements } from "../../session/measured_links";
import { withPageView } from "../../session/page_view";
import { permalinkOf } from "../../session/permalink";
import type { SessionController } from "../../session/session_controller";
import type { Signal } from "../../state/signal";
import { t } from "../../language/translate";

/** What the dialog acts on. */
export interface Sharing {
  controller: SessionController;
  report: Signal<CompileReport | undefined>;
  /** Opens the page with this query string. */
  open(query: string): void;
  photograph(): void;
  /** Returns what is measured, which the links hold. */
  measured(): KeptMeasurement[];
  /** Rows at the head of the list of copies. */
  rows: HTMLElement[];
}

/** A dialog with links to this session, copies of it, and a screenshot. */
export class ShareDialog {
  readonly element = make("dialog", { className: "chooser", id: "share", ariaLabel: t("Share and copy") });
  private readonly session = linkRow("share-session", t("This session, for others to join"));
  private readonly forClass = linkRow("share-class", t("For a class: plain words and few controls"));
  private readonly frame = linkRow("share-embed", t("HTML to embed the view in another page"));
  private readonly permalink = linkRow("share-permalink", t("This state, simulated again when the link is opened"));

  constructor(private readonly sharing: Sharing) {
    const close = make("button", { type: "button", onclick: () => this.element.close() }, t("Close"));
    const rerunWords = t(
      "Contains scene, parameters and tick. The state is identical, bit for bit, if the parameters have not changed since the start.",
    );
    this.element.append(
      make("header", {}, make("h2", {}, t("Share")), close),
      this.session.row,
      this.forClass.row,
      this.permalink.row,
      make("p", { className: "faint" }, rerunWords, " ", t("The links above hold what is measured.")),
      this.frame.row,
      make("p", { className: "faint" }, t("Pages of other origins need phrenicd --allow-origin.")),
      make("h2", {}, t("Copy")),
      make("ul", {}, ...this.copies()),
    );
  }

  /** Opens the dialog with links to the current state. */
  show(): void {
    const { controller, report } = this.sharing;
    const session = controller.session.value;
    const base = `${location.origin}${location.pathname}`;
    const measured = this.sharing.measured();
    const here = `?${new URLSearchParams({ session: controller.sessionId })}`;
    this.session.entry.value = base + withMeasurements(here, measured);
    this.forClass.entry.value = base + withPageView(new URL(this.session.entry.value).search, "student");
    const embedded = `${base}?${new URLSearchParams({ session: controller.sessionId })}&amp;embed`;
    this.frame.entry.value = `<iframe src="${embedded}" width="720" height="540" title="Phrenic"></iframe>`;
    const hash = report.value?.sceneHash ?? "";
    if (session !== undefined)
      this.permalink.entry.value = base + withMeasurements(permalinkOf(session, hash), measured);
    this.element.showModal();
  }

  private copies(): HTMLElement[] {
    const { controller, open, photograph } = this.sharing;
    const here = controller.sessionId;
    return [
      ...this.sharing.rows,
      action("share-fork", t("Your own copy"), t("A copy in the current state that you own."), t("Fork"), async () => {
        const id = await controller.fork();
        if (id !== undefined) open(`?${new URLSearchParams({ session: id })}`);
      }),
      action(
        "share-compare",
        t("Side by side"),
        t("A copy beside this session, with its own parameters and a common camera."),
        t("Compare"),
        async () => {
          const id = await controller.forkForComparison();
          if (id !== undefined) open(`?${new URLSearchParams({ session: id, beside: here })}`);
        },
      ),
      action("share-picture", t("Screenshot"), t("The current view as PNG."), t("Save"), async () => photograph()),
    ];
  }
}

function linkRow(id: string, label: string) {
  const entry = make("input", { type: "text", id, readOnly: true });
  entry.onfocus = () => entry.select();
  const copy = make("button", { type: "button", ariaLabel: t("Copy the link: {0}", label) }, t("Copy"));
  copy.onclick = async () => {
    // The clipboard may be unavailable; selected text can always be copied.
    await navigator.clipboard?.writeText(entry.value).catch(() => entry.select());
    copy.textContent = t("Copied");
    setTimeout(() => (copy.textContent = t("Copy")), 1500);
  };
  return { row: make("div", { className: "link-row" }, make("label", { htmlFor: id }, label), entry, copy), entry };
}

function action(id: string, title: string, detail: string, verb: string, act: () => Promise<void>): HTMLElement {
  const go = make("button", { type: "button", id, ariaLabel: `${verb}: ${title}` }, verb);
  go.onclick = async () => {
    go.disabled = true;
    await act();
    go.disabled = false;
  };
  return make("li", {}, make("div", {}, make("b", {}, title), make("span", {}, detail)), go);
}
