import type { Interceptor } from "@connectrpc/connect";
import type { Memory } from "./identity";

const mostLinks = 8;

/** What this browser may show a server that knows its users: an account's token, and the secrets of join links. */
export class Access {
  constructor(private readonly memory: Memory) {}

  get token(): string {
    return this.memory.getItem("phrenic-account") ?? "";
  }

  set token(token: string) {
    this.memory.setItem("phrenic-account", token);
  }

  /** The newest ones. */
  get links(): string[] {
    return (this.memory.getItem("phrenic-links") ?? "").split(",").filter((secret) => secret !== "");
  }

  keepLink(secret: string): void {
    const others = this.links.filter((other) => other !== secret);
    this.memory.setItem("phrenic-links", [...others, secret].slice(-mostLinks).join(","));
  }
}

/** Keeps the secret of a join link, "#join=SECRET": what follows # is sent to no server. */
export function takeLink(address: URL, access: Access): void {
  const secret = new URLSearchParams(address.hash.slice(1)).get("join") ?? "";
  if (/^[0-9a-f]{32}$/.test(secret)) access.keepLink(secret);
}

/** Says with every call who calls. */
export function identifying(access: Access): Interceptor {
  return (next) => (request) => {
    if (access.token !== "") request.header.set("authorization", `Bearer ${access.token}`);
    if (access.links.length > 0) request.header.set("x-join", access.links.join(","));
    return next(request);
  };
}
