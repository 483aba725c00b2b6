import type { Api } from "../connection/api";
import { Signal } from "../state/signal";
import { type BodyNumbers, sameNumbers } from "./body_numbers";

/** The scene that is made as a person: the generated thorax. */
const scene = "thorax";

/** Numbers of a body that a user chooses, and the session that is made with them. */
export class BodySession {
  readonly numbers = new Signal<BodyNumbers>({});

  constructor(private readonly api: Api) {}

  /** Replaces all numbers. */
  take(numbers: BodyNumbers): void {
    this.numbers.set({ ...numbers });
  }

  /** Sets one number [SI units]; undefined leaves it to sex and age. */
  set(field: string, value: number | undefined): void {
    const { [field]: _, ...others } = this.numbers.value;
    this.numbers.set(value === undefined ? others : { ...others, [field]: value });
  }

  /** True if these are the chosen numbers. */
  has(numbers: BodyNumbers): boolean {
    return sameNumbers(this.numbers.value, numbers);
  }

  /** Creates and plays a session of the thorax with this body. Returns its id. Throws ConnectError. */
  async start(): Promise<string> {
    const { session } = await this.api.sessions.createSession({
      source: { source: { case: "name", value: scene }, physique: this.numbers.value },
    });
    const sessionId = session!.id;
    await this.api.sessions.playSession({ sessionId });
    return sessionId;
  }
}
