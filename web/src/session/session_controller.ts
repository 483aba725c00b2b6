import type { MessageInitShape } from "@bufbuild/protobuf";
import { type Api, errorText, isUnreachable } from "../connection/api";
import type { Control } from "../gen/phrenic/v1/control_pb";
import type { ParametersSchema } from "../gen/phrenic/v1/parameters_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import { type PullSchema, type Session, SessionState } from "../gen/phrenic/v1/session_pb";
import { parameterControls, type ParameterName } from "../parameters/controls";
import { Signal } from "../state/signal";
import { UndoHistory, type Values } from "../state/undo_history";
import type { Clock } from "../timing/clock";
import { CoalescingSender } from "../timing/coalescing_sender";

type PullValues = MessageInitShape<typeof PullSchema>;
/** Some live parameters. */
export type ParameterValues = Omit<MessageInitShape<typeof ParametersSchema>, "$typeName">;

/** Playback speed: simulated seconds per second, or as fast as possible. */
export type Speed = number | "fastest";

/** Largest time difference that is caught up by steps [s]; the server has the same limit. */
const maxTimeDifference = 2;

/**
 * Controls one session: playback, parameters, pulls and copies. Each response updates `session`; each refusal sets
 * `notice`.
 */
export class SessionController {
  readonly session = new Signal<Session | undefined>(undefined);
  /** The last refusal or warning of the server; empty after a successful call. */
  readonly notice = new Signal("");
  private readonly updates: CoalescingSender<ParameterValues>;
  private readonly pulls: CoalescingSender<Record<string, PullValues>>;
  /** The parameter changes of this viewer. */
  readonly changes = new UndoHistory();
  /** Another session that plays, pauses, steps and resets with this one. */
  companion: SessionController | undefined;

  constructor(
    private readonly api: Api,
    readonly sessionId: string,
    private readonly clock: Clock,
  ) {
    // The controls show the actual values after each change, also after a refused one.
    const showAll = () => this.session.set(this.session.value);
    this.updates = new CoalescingSender<ParameterValues>((change) => this.send(change), clock, showAll);
    this.pulls = new CoalescingSender(
      (change) => this.sendPulls(Object.values(change).filter((pull) => pull !== undefined)),
      clock,
      () => undefined,
    );
  }

  /** Sets the session state unless it is older than the known one. `fresh` accepts any state, for a new connection. */
  receive(session: Session | undefined, fresh = false): void {
    const known = this.session.value;
    if (session === undefined) return;
    if (fresh) this.notice.set("");
    if (!fresh && known !== undefined) {
      if (session.revision < known.revision) return;
      // Control has its own revision: a newer state may contain older control information.
      if ((session.control?.revision ?? 0n) < (known.control?.revision ?? 0n)) session.control = known.control;
    }
    this.session.set(session);
  }

  /** Sets who controls the session unless it is older than the known state. */
  receiveControl(control: Control): void {
    const known = this.session.value;
    if (known === undefined || control.revision < (known.control?.revision ?? 0n)) return;
    this.session.set({ ...known, control });
  }

  /** Plays; with a companion, each session waits for the other. Returns false if the server refused it. */
  play(speed: Speed): Promise<boolean> {
    void this.companion?.playSynchronised(speed, this.sessionId);
    return this.playSynchronised(speed, this.companion?.sessionId);
  }

  /** Pauses; with a companion, both stop at the same simulated time. Returns false if the server refused it. */
  async pause(): Promise<boolean> {
    const [paused] = await Promise.all([this.pauseThis(), this.companion?.pauseThis()]);
    await this.alignTimes();
    return paused;
  }

  /** Pauses both sessions, lets the one behind catch up, and plays on in step. */
  async resynchronise(): Promise<void> {
    const speed = this.currentSpeed;
    await this.pause();
    await this.play(speed);
  }

  /** Steps; with a companion, both end at the same simulated time. */
  async step(ticks: number): Promise<void> {
    await Promise.all([this.stepThis(ticks), this.companion?.stepThis(ticks)]);
    await this.alignTimes();
  }

  /** Resets the session to its initial state; with a companion, both. */
  async reset(): Promise<void> {
    void this.companion?.reset();
    await this.call(() => this.api.sessions.resetSession({ sessionId: this.sessionId }));
  }

  /** Sets a parameter and records the change for undo; rapid changes are merged. */
  set(name: ParameterName, value: number | boolean): void {
    this.setTogether({ [name]: value });
  }

  /** Sets parameters that one control changes together; they are undone together. */
  setTogether(values: Values): void {
    const known = { ...this.session.value?.parameters } as unknown as Values;
    const names = Object.keys(values).filter((name) => known[name] !== undefined && known[name] !== values[name]);
    const part = (of: Values) => Object.fromEntries(names.map((name) => [name, of[name]]));
    if (names.length > 0) this.changes.record(part(known), part(values), this.clock.now());
    this.updates.push(values);
  }

  /** Reverts the last change of this viewer. */
  undo(): void {
    this.setAll(this.changes.undo());
  }

  /** Repeats the last change that was undone. */
  redo(): void {
    this.setAll(this.changes.redo());
  }

  /** Sets all parameters to the initial values of the scene. */
  async resetAll(): Promise<void> {
    const start = await this.startValues();
    if (start !== undefined) await this.recordChange(() => this.send(start));
  }

  /** Pulls a vertex with a constant force [N]; zero releases it. */
  pull(body: string, vertex: number, [x, y, z]: [number, number, number]): void {
    this.pulls.push({ [`${body}:${vertex}`]: { body, vertex, force: { x, y, z } } });
  }

  /** Sends pending changes immediately, before the page is closed. */
  flush(): void {
    this.updates.flush();
    this.pulls.flush();
  }

  /** Releases all pulled vertices, also those of other viewers. */
  async releasePulls(): Promise<void> {
    await this.call(() => this.api.sessions.pullSession({ sessionId: this.sessionId, releaseOthers: true }));
  }

  /** Sets parameters immediately and resolves when they are applied. */
  apply(parameters: ParameterValues): Promise<void> {
    return this.send(parameters);
  }

  /** True if this viewer's change of `name` is not answered yet. */
  pending(name: ParameterName): boolean {
    return this.updates.pending(name);
  }

  /** Sets the parameters of one of the scene's presets; `overrides` take precedence over them. */
  usePreset(preset: string, overrides: ParameterValues = {}): Promise<void> {
    return this.recordChange(() => this.send(overrides, preset));
  }

  /**
   * Creates a copy of this session in its current state, playing if this one plays. Returns its id, or undefined on
   * failure.
   */
  async fork(): Promise<string | undefined> {
    const fork = await this.createFork();
    if (fork !== undefined && this.playing) await fork.play(this.currentSpeed);
    return fork?.sessionId;
  }

  /**
   * Creates a copy to compare with, with a preset if one is named: both start at the same time and play in step if this
   * session plays. Returns its id, or undefined on failure.
   */
  async forkForComparison(preset = ""): Promise<string | undefined> {
    const [playing, speed] = [this.playing, this.currentSpeed];
    if (playing) await this.pause();
    const fork = await this.createFork();
    if (fork !== undefined && preset !== "") await fork.usePreset(preset);
    this.companion = fork;
    if (playing) await this.play(speed);
    return fork?.sessionId;
  }

  private get playing(): boolean {
    return this.session.value?.state === SessionState.PLAYING;
  }

  /** The current or last playback speed. */
  private get currentSpeed(): Speed {
    return this.session.value?.speed || "fastest";
  }

  private async createFork(): Promise<SessionController | undefined> {
    try {
      const { session } = await this.api.sessions.forkSession({ sessionId: this.sessionId, temporary: true });
      return session === undefined ? undefined : new SessionController(this.api, session.id, this.clock);
    } catch (error) {
      this.notice.set(errorText(error));
      return undefined;
    }
  }

  private playSynchronised(speed: Speed, inStepWith = ""): Promise<boolean> {
    const pace = speed === "fastest" ? { asFastAsPossible: true } : { speed };
    return this.call(() => this.api.sessions.playSession({ sessionId: this.sessionId, inStepWith, ...pace }));
  }

  private pauseThis(): Promise<boolean> {
    return this.call(() => this.api.sessions.pauseSession({ sessionId: this.sessionId }));
  }

  private async stepThis(ticks: number): Promise<void> {
    await this.call(() => this.api.sessions.stepSession({ sessionId: this.sessionId, ticks: BigInt(ticks) }));
  }

  /** Lets the paused session that is behind step to the time of the other, if the difference is small. */
  private async alignTimes(): Promise<void> {
    const { companion } = this;
    const timeDifference = (companion?.session.value?.time ?? 0) - (this.session.value?.time ?? 0);
    if (companion === undefined || Math.abs(timeDifference) > maxTimeDifference) return;
    const behind = timeDifference > 0 ? this : companion;
    const ticks = Math.round(Math.abs(timeDifference) / (behind.session.value?.parameters?.timeStep ?? Infinity));
    if (ticks > 0) await behind.stepThis(ticks);
  }

  private setAll(values: Values | undefined): void {
    if (values !== undefined) this.updates.push(values);
  }

  /** Records the parameter changes that `change` causes for undo. */
  private async recordChange(change: () => Promise<void>): Promise<void> {
    const before = { ...this.session.value?.parameters } as unknown as Values;
    await change();
    const after = { ...this.session.value?.parameters } as unknown as Values;
    const names = parameterControls().map(({ field }) => field);
    const changed = names.filter((name) => before[name] !== undefined && before[name] !== after[name]);
    const part = (values: Values) => Object.fromEntries(changed.map((name) => [name, values[name]]));
    if (changed.length > 0) this.changes.record(part(before), part(after), this.clock.now());
  }

  /** Returns the initial parameters of the scene. */
  async startValues(): Promise<ParameterValues | undefined> {
    try {
      return (await this.describe()).sceneParameters;
    } catch (error) {
      this.notice.set(errorText(error));
      return undefined;
    }
  }

  /** Returns the presets of the session's scene; empty if the server does not answer. */
  async presets(): Promise<Preset[]> {
    try {
      return (await this.describe()).presets;
    } catch {
      return [];
    }
  }

  private describe() {
    return this.api.sessions.getSession({ sessionId: this.sessionId });
  }

  private async send(parameters: ParameterValues, preset = ""): Promise<void> {
    await this.call(async () => {
      const answer = await this.api.sessions.updateParameters({ sessionId: this.sessionId, parameters, preset });
      return { session: answer.session, notice: answer.warnings.join(" ") };
    });
  }

  private async sendPulls(pulls: PullValues[]): Promise<void> {
    await this.call(() => this.api.sessions.pullSession({ sessionId: this.sessionId, pulls }));
  }

  /** Returns true on success. */
  private async call(call: () => Promise<{ session?: Session; notice?: string }>): Promise<boolean> {
    try {
      const { session, notice } = await call();
      this.receive(session);
      this.notice.set(notice ?? "");
      return true;
    } catch (error) {
      // The connection reports an unreachable server.
      if (!isUnreachable(error)) this.notice.set(errorText(error));
      return false;
    }
  }
}
