import type { Interceptor } from "@connectrpc/connect";

/** The session that a request is about; empty where there is none. */
function sessionOf(message: unknown): string {
  const { sessionId } = message as { sessionId?: unknown };
  return typeof sessionId === "string" ? sessionId : "";
}

async function* withFirst<T>(first: IteratorResult<T>, rest: AsyncIterator<T>): AsyncIterable<T> {
  for (let item = first; !item.done; item = await rest.next()) yield item.value;
}

/** Names the session in the head of every call that is about one: by it a cluster's front chooses the server. */
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
