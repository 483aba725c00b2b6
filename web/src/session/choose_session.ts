import { timestampMs } from "@bufbuild/protobuf/wkt";
import type { Api } from "../connection/api";
import { type Session, SessionState } from "../gen/phrenic/v1/session_pb";
import { Backoff } from "../timing/backoff";
import type { Clock } from "../timing/clock";

/**
 * Returns the session that a page without a session in its address opens, or undefined without sessions. It prefers, in
 * this order: one that is no temporary copy of a comparison, one that plays (a diverged one comes last), one of a thorax,
 * the one with the most viewers, the newest.
 */
export function preferredSession(sessions: Session[]): Session | undefined {
  const [first, ...others] = sessions;
  return others.reduce<Session | undefined>(
    (best, session) => (best !== undefined && comesBefore(session, best) ? session : best),
    first,
  );
}

const states = [SessionState.DIVERGED, SessionState.PAUSED, SessionState.PLAYING];

function comesBefore(a: Session, b: Session): boolean {
  const ranks = ({ temporary, state, scene, sceneTitle, viewers, createTime }: Session) => [
    temporary ? 0 : 1,
    states.indexOf(state),
    /^(thorax|person)(-|$)/.test(scene) || sceneTitle.startsWith("Thorax of ") ? 1 : 0,
    viewers,
    createTime === undefined ? 0 : timestampMs(createTime),
  ];
  const [left, right] = [ranks(a), ranks(b)];
  const i = left.findIndex((rank, at) => rank !== right[at]);
  return i >= 0 && left[i] > right[i];
}

/** Sessions that the page reads at once, the server's most. */
const pageSize = 1000;

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
      const { sessions } = await api.sessions.listSessions({ pageSize }, { timeoutMs: 8000 });
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
