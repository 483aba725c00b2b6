import { createRouterTransport } from "@connectrpc/connect";
import { expect, test } from "vitest";
import { createApi } from "../../../web/src/connection/api";
import { routingInterceptor } from "../../../web/src/connection/routing";
import { FrameService } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { SessionService } from "../../../web/src/gen/phrenic/v1/session_pb";

test("calls about a session carry its id in the header, others do not", async () => {
  const named: (string | null)[] = [];
  const transport = createRouterTransport(
    ({ service }) => {
      service(SessionService, {
        getSession(_, { requestHeader }) {
          named.push(requestHeader.get("x-session-id"));
          return {};
        },
        listSessions(_, { requestHeader }) {
          named.push(requestHeader.get("x-session-id"));
          return {};
        },
      });
      service(FrameService, {
        async *watchFrames({ sessionId }, { requestHeader }) {
          named.push(requestHeader.get("x-session-id"));
          expect(sessionId).toBe("b");
          yield {};
        },
      });
    },
    { transport: { interceptors: [routingInterceptor()] } },
  );
  const api = createApi(transport);
  await api.sessions.getSession({ sessionId: "a" });
  await api.sessions.listSessions({});
  for await (const event of api.frames.watchFrames({ sessionId: "b" })) expect(event).toBeDefined();
  expect(named).toEqual(["a", null, "b"]);
});
