import type { Api } from "./api";
import { Backoff } from "./backoff";
import type { Clock } from "./clock";
import { type Session, SessionState } from "./gen/phrenic/v1/session_pb";

/** The session that a page with no session in its address opens: the first that plays, or else the first. */
export function preferred(sessions: Session[]): Session | undefined {
  return sessions.find((session) => session.state === SessionState.PLAYING) ?? sessions[0];
}

/**
 * The id in the page's address, or the preferred session's, asked for until the server answers. Undefined where the
 * server has no session at all. `waiting` hears of each failure.
 */
export async function chooseSession(
  address: URL,
  api: Api,
  clock: Clock,
  waiting: (error: unknown) => void,
): Promise<string | undefined> {
  const named = address.searchParams.get("session");
  if (named !== null && named !== "") return named;
  const backoff = new Backoff();
  for (;;) {
    try {
      const { sessions } = await api.sessions.listSessions({}, { timeoutMs: 8000 });
      return preferred(sessions)?.id;
    } catch (error) {
      waiting(error);
      await clock.sleep(backoff.next());
    }
  }
}
