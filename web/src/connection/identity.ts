import type { Interceptor } from "@connectrpc/connect";

/** What a browser remembers under a key; the page's localStorage, or a map in tests. */
export type Memory = Pick<Storage, "getItem" | "setItem">;

/** This person's name, and the tokens by which each session knows them; remembered by the browser, shown to nobody. */
export class Identity {
  constructor(private readonly memory: Memory) {}

  get name(): string {
    return this.memory.getItem("phrenic-name") ?? "";
  }

  set name(name: string) {
    this.memory.setItem("phrenic-name", name);
  }

  /** Whether the picture follows whoever controls. */
  get follows(): boolean {
    return this.memory.getItem("phrenic-follow") === "on";
  }

  set follows(on: boolean) {
    this.memory.setItem("phrenic-follow", on ? "on" : "off");
  }

  tokenOf(sessionId: string): string {
    return this.tokens()[sessionId] ?? "";
  }

  keepToken(sessionId: string, token: string): void {
    const { [sessionId]: _, ...others } = this.tokens();
    const kept = [...Object.entries(others), [sessionId, token]].slice(-mostTokens);
    this.memory.setItem("phrenic-tokens", JSON.stringify(Object.fromEntries(kept)));
  }

  private tokens(): Record<string, string> {
    try {
      return JSON.parse(this.memory.getItem("phrenic-tokens") ?? "{}") as Record<string, string>;
    } catch {
      return {};
    }
  }
}

const mostTokens = 200;

/** The fields of requests and answers that are about who calls. */
interface Signed {
  sessionId?: string;
  controlToken?: string;
  ownerName?: string;
  session?: { id: string };
}

/** Signs every call that asks for it with this person's token or name, and keeps the tokens that are answered. */
export function signing(identity: Identity): Interceptor {
  return (next) => async (request) => {
    const asked = request.message as Signed;
    if (!request.stream && asked.controlToken === "") asked.controlToken = identity.tokenOf(asked.sessionId ?? "");
    if (!request.stream && asked.ownerName === "") asked.ownerName = identity.name;
    const response = await next(request);
    const { controlToken, session } = response.message as Signed;
    if (!response.stream && controlToken) identity.keepToken(session?.id ?? asked.sessionId ?? "", controlToken);
    return response;
  };
}
