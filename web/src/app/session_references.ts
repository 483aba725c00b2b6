import type { Api } from "../connection/api";
import type { Parameters } from "../gen/phrenic/v1/parameters_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import type { ShownReferences } from "../graphs/references";
import { breathLengthOf } from "../parameters/effort";
import { activePreset } from "../parameters/presets";
import type { SessionController } from "../session/session_controller";
import type { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";

/** Time after an error before the references are read again [ms]. */
const afterError = 15_000;

/** The ranges of health and static curves of a session, read again when its compliances change. */
export class SessionReferences {
  private read: Omit<ShownReferences, "breath" | "period"> | undefined;
  private key = "";
  /** The earliest time of the next call [ms]. */
  private earliest = 0;

  constructor(
    private readonly api: Api,
    private readonly controller: SessionController,
    private readonly presets: Signal<Preset[]>,
    /** Called after the references were read. */
    private readonly changed: () => void,
    private readonly clock: Clock,
  ) {}

  /** Reads the references now, and again after changes. */
  start(): void {
    this.controller.session.subscribe((session) => void this.follow(session?.parameters));
  }

  /** What graphs show beside the breath now; undefined before it is known. */
  readonly now = (): ShownReferences | undefined => {
    const parameters = this.controller.session.value?.parameters;
    if (this.read === undefined || parameters === undefined) return undefined;
    const breath = activePreset(this.presets.value, parameters)?.name ?? "";
    return { ...this.read, breath, period: breathLengthOf(parameters) };
  };

  /** An error leaves the references as they are; the next state of the session after a pause tries again. */
  private async follow(parameters: Parameters | undefined): Promise<void> {
    if (parameters === undefined) return;
    const { lungCompliance, chestWallCompliance, abdominalCompliance } = parameters;
    const key = [lungCompliance, chestWallCompliance, abdominalCompliance].join();
    if (key === this.key || this.clock.now() < this.earliest) return;
    this.key = key;
    const { sessionId } = this.controller;
    try {
      const { ranges, curves } = await this.api.references.getReferences({ sessionId }, { timeoutMs: 8000 });
      const { backdropOf } = await import("../graphs/references");
      this.read = { ranges, curves, backdropOf };
      this.changed();
    } catch {
      this.key = "";
      this.earliest = this.clock.now() + afterError;
    }
  }
}
