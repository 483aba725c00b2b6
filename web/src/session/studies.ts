import { type Client, createClient } from "@connectrpc/connect";
import { type Api, errorText } from "../connection/api";
import type { Parameters } from "../gen/phrenic/v1/parameters_pb";
import { type Study, StudyService, StudyState } from "../gen/phrenic/v1/study_pb";
import { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";

/** The kinds of study. */
export type StudyKind = "error" | "stability" | "cost" | "streaming";

/** The studies on the server: lists, starts, watches and cancels them. */
export class Studies {
  readonly all = new Signal<Study[]>([]);
  /** The error of the last call; empty on success. */
  readonly errorMessage = new Signal("");
  private readonly calls: Client<typeof StudyService>;
  private readonly watched = new Set<string>();

  constructor(
    { transport }: Pick<Api, "transport">,
    private readonly clock: Clock,
  ) {
    this.calls = createClient(StudyService, transport);
  }

  /** Loads the studies and watches those that are not finished. */
  async load(): Promise<void> {
    await this.call(async () => {
      const { studies } = await this.calls.listStudies({});
      this.all.set(studies);
      for (const study of studies) if (!isFinished(study)) void this.watch(study.id);
    });
  }

  /** Starts a study of a catalogue scene with these parameters. */
  async start(kind: StudyKind, scene: string, parameters: Parameters | undefined): Promise<void> {
    await this.call(async () => {
      const { study } = await this.calls.createStudy({
        source: { source: { case: "name", value: scene } },
        parameters,
        // The meshes of the thesis' sizes take minutes to generate and are independent of this scene.
        what: kind === "cost" ? { case: kind, value: { leaveOutSizes: true } } : { case: kind, value: {} },
      });
      if (study === undefined) return;
      this.replaceOrAdd(study);
      void this.watch(study.id);
    });
  }

  /** Cancels a running study and deletes it. */
  async remove(studyId: string): Promise<void> {
    await this.call(() => this.calls.deleteStudy({ studyId }));
    this.all.set(this.all.value.filter(({ id }) => id !== studyId));
  }

  /** Returns a study with its result when it is finished. */
  async result(studyId: string): Promise<Study | undefined> {
    for await (const { study } of this.calls.watchStudy({ studyId })) if (study && isFinished(study)) return study;
    return undefined;
  }

  /** Returns its tables and plots as one HTML file. */
  async page(studyId: string): Promise<string> {
    return (await this.calls.getStudyPage({ studyId })).html;
  }

  private async watch(studyId: string): Promise<void> {
    if (this.watched.has(studyId)) return;
    this.watched.add(studyId);
    const known = () => this.all.value.some(({ id }) => id === studyId);
    while (known()) {
      try {
        for await (const { study } of this.calls.watchStudy({ studyId })) {
          if (study !== undefined && known()) this.replaceOrAdd(study);
        }
        break;
      } catch {
        // The server may come back, with the study or without it.
        await this.clock.sleep(3000);
        await this.load();
      }
    }
    this.watched.delete(studyId);
  }

  private replaceOrAdd(study: Study): void {
    const rest = this.all.value.filter(({ id }) => id !== study.id);
    const order = this.all.value.findIndex(({ id }) => id === study.id);
    this.all.set(order < 0 ? [...rest, study] : this.all.value.with(order, study));
  }

  private async call(call: () => Promise<unknown>): Promise<void> {
    try {
      await call();
      this.errorMessage.set("");
    } catch (error) {
      this.errorMessage.set(errorText(error));
    }
  }
}

/** True if a study is done or failed. */
export function isFinished({ state }: Study): boolean {
  return state === StudyState.DONE || state === StudyState.FAILED;
}
