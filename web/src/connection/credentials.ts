import type { Interceptor } from "@connectrpc/connect";
import type { KeyValueStorage } from "./identity";

const maxLinks = 8;

/** Credentials that this browser stores for servers with accounts: an account token and the secrets of join links. */
export class Credentials {
  constructor(private readonly storage: KeyValueStorage) {}

  /** The account token; empty without one. */
  get token(): string {
    return this.storage.getItem("phrenic-account") ?? "";
  }

  set token(token: string) {
    this.storage.setItem("phrenic-account", token);
  }

  /** Secrets of the most recent join links. */
  get joinLinks(): string[] {
    return (this.storage.getItem("phrenic-links") ?? "").split(",").filter((secret) => secret !== "");
  }

  /** Adds a secret; keeps the eight most recent ones. */
  addJoinLink(secret: string): void {
    const others = this.joinLinks.filter((other) => other !== secret);
    this.storage.setItem("phrenic-links", [...others, secret].slice(-maxLinks).join(","));
  }
}

/** Stores the secret of a join link, "#join=SECRET". Browsers do not send the fragment to a server. */
export function storeJoinLink(address: URL, credentials: Credentials): void {
  const secret = new URLSearchParams(address.hash.slice(1)).get("join") ?? "";
  if (/^[0-9a-f]{32}$/.test(secret)) credentials.addJoinLink(secret);
}

/** Adds the credentials to the header of each call. */
export function credentialsInterceptor(credentials: Credentials): Interceptor {
  return (next) => (request) => {
    if (credentials.token !== "") request.header.set("authorization", `Bearer ${credentials.token}`);
    if (credentials.joinLinks.length > 0) request.header.set("x-join", credentials.joinLinks.join(","));
    return next(request);
  };
}
