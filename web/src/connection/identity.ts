import type { Interceptor } from "@connectrpc/connect";

/** A persistent key-value store: localStorage in the page, a map in tests. */
export type KeyValueStorage = Pick<Storage, "getItem" | "setItem">;

/** The user's name and the control token for each session, stored in the browser. */
export class Identity {
  constructor(readonly storage: KeyValueStorage) {}

  /** The user's name; empty until it is set. */
  get name(): string {
    return this.storage.getItem("phrenic-name") ?? "";
  }

  set name(name: string) {
    this.storage.setItem("phrenic-name", name);
  }

  /** The secret that identifies this browser among those who answer a lesson's questions. */
  get respondent(): string {
    const known = this.storage.getItem("phrenic-respondent") ?? "";
    if (known !== "") return known;
    const bytes = [...crypto.getRandomValues(new Uint8Array(16))];
    const secret = bytes.map((byte) => byte.toString(16).padStart(2, "0")).join("");
    this.storage.setItem("phrenic-respondent", secret);
    return secret;
  }

  /** True if a school's platform launched this page. */
  get launched(): boolean {
    return this.storage.getItem("phrenic-launch") !== null;
  }

  /** True if the platform knows the user as a learner, whose answers count for the course. */
  get isGraded(): boolean {
    return this.storage.getItem("phrenic-launch") === "learner";
  }

  /** True if the camera follows that of the participant in control. */
  get followsCamera(): boolean {
    return this.storage.getItem("phrenic-follow") === "on";
  }

  set followsCamera(on: boolean) {
    this.storage.setItem("phrenic-follow", on ? "on" : "off");
  }

  /** Returns the control token for a session; empty without one. */
  tokenOf(sessionId: string): string {
    return this.tokens()[sessionId] ?? "";
  }

  /** Stores the control token for a session; keeps the 200 most recent ones. */
  storeToken(sessionId: string, token: string): void {
    const { [sessionId]: _, ...others } = this.tokens();
    const kept = [...Object.entries(others), [sessionId, token]].slice(-maxTokens);
    this.storage.setItem("phrenic-tokens", JSON.stringify(Object.fromEntries(kept)));
  }

  private tokens(): Record<string, string> {
    try {
      return JSON.parse(this.storage.getItem("phrenic-tokens") ?? "{}") as Record<string, string>;
    } catch {
      return {};
    }
  }
}

const maxTokens = 200;

/** Fields of requests and responses that identify the caller. */
interface IdentityFields {
  sessionId?: string;
  controlToken?: string;
  ownerName?: string;
  session?: { id: string };
}

/** Fills in the control token or name of requests that have such a field, and stores the tokens in responses. */
export function identityInterceptor(identity: Identity): Interceptor {
  return (next) => async (request) => {
    const asked = request.message as IdentityFields;
    if (!request.stream && asked.controlToken === "") asked.controlToken = identity.tokenOf(asked.sessionId ?? "");
    if (!request.stream && asked.ownerName === "") asked.ownerName = identity.name;
    const response = await next(request);
    const { controlToken, session } = response.message as IdentityFields;
    if (!response.stream && controlToken) identity.storeToken(session?.id ?? asked.sessionId ?? "", controlToken);
    return response;
  };
}
