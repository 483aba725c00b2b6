import type { Interceptor } from "@connectrpc/connect";

/** Returns the session id of a request; empty if it has none. */
function sessionOf(message: unknown): string {
  const { sessionId } = message as { sessionId?: unknown };
  return typeof sessionId === "string" ? sessionId : "";
}

async function* withFirst<T>(first: IteratorResult<T>, rest: AsyncIterator<T>): AsyncIterable<T> {
  for (let item = first; !item.done; item = await rest.next()) yield item.value;
}

/**
 * Adds the session id to the header of each call about a session, by which the router of a cluster selects the server.
 */
export function routingInterceptor(): Interceptor {
  return (next) => async (request) => {
    if (!request.stream) {
      const id = sessionOf(request.message);
      if (id !== "") request.header.set("x-session-id", id);
      return next(request);
    }
    const messages = request.message[Symbol.asyncIterator]();
    const first = await messages.next();
    const id = first.done ? "" : sessionOf(first.value);
    if (id !== "") request.header.set("x-session-id", id);
    return next({ ...request, message: withFirst(first, messages) });
  };
}
