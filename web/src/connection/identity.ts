import type { Interceptor } from "@connectrpc/connect";

/** What a browser remembers under a key; the page's localStorage, or a map in tests. */
export type KeyValueStorage = Pick<Storage, "getItem" | "setItem">;

/** This person's name, and the tokens by which each session knows them; remembered by the browser, shown to nobody. */
export class Identity {
  constructor(private readonly storage: KeyValueStorage) {}

  get name(): string {
    return this.storage.getItem("phrenic-name") ?? "";
  }

  set name(name: string) {
    this.storage.setItem("phrenic-name", name);
  }

  /** Whether the picture follows whoever controls. */
  get followsCamera(): boolean {
    return this.storage.getItem("phrenic-follow") === "on";
  }

  set followsCamera(on: boolean) {
    this.storage.setItem("phrenic-follow", on ? "on" : "off");
  }

  tokenOf(sessionId: string): string {
    return this.tokens()[sessionId] ?? "";
  }

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

/** The fields of requests and answers that are about who calls. */
interface IdentityFields {
  sessionId?: string;
  controlToken?: string;
  ownerName?: string;
  session?: { id: string };
}

/** Signs every call that asks for it with this person's token or name, and keeps the tokens that are answered. */
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
