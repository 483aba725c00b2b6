import type { Api } from "../connection/api";
import { type Session, SessionState } from "../gen/phrenic/v1/session_pb";
import { Backoff } from "../timing/backoff";
import type { Clock } from "../timing/clock";

/** Returns the session that a page without a session in its address opens: the first playing one, or the first. */
export function preferredSession(sessions: Session[]): Session | undefined {
  return sessions.find((session) => session.state === SessionState.PLAYING) ?? sessions[0];
}

/** Polling interval while the server has no session [ms]. */
const pollInterval = 1500;

/**
 * Returns the session id of the page's address, or that of the preferred session, and waits until there is one: a
 * server that has just started may still compile its first scene. Calls `onWaiting` with the error, or without one if
 * there is no session.
 */
export async function chooseSession(
  address: URL,
  api: Api,
  clock: Clock,
  onWaiting: (error?: unknown) => void,
): Promise<string> {
  const named = address.searchParams.get("session");
  if (named !== null && named !== "") return named;
  const backoff = new Backoff();
  for (;;) {
    try {
      const { sessions } = await api.sessions.listSessions({}, { timeoutMs: 8000 });
      const found = preferredSession(sessions);
      if (found !== undefined) return found.id;
      onWaiting();
      await clock.sleep(pollInterval);
    } catch (error) {
      onWaiting(error);
      await clock.sleep(backoff.next());
    }
  }
}
