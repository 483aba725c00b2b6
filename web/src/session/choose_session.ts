import type { Api } from "../connection/api";
import { type Session, SessionState } from "../gen/phrenic/v1/session_pb";
import { Backoff } from "../timing/backoff";
import type { Clock } from "../timing/clock";

/** The session that a page with no session in its address opens: the first that plays, or else the first. */
export function preferredSession(sessions: Session[]): Session | undefined {
  return sessions.find((session) => session.state === SessionState.PLAYING) ?? sessions[0];
}

/** How often to look again where the server has no session yet [ms]. */
const pollInterval = 1500;

/**
 * The id in the page's address, or the preferred session's, asked for until there is one: a server that has just been
 * started may still be building its first scene. `waiting` hears what went wrong, or nothing where there is just no
 * session.
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
