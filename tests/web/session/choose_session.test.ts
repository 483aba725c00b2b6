import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { SessionSchema, SessionState } from "../../../web/src/gen/phrenic/v1/session_pb";
import { chooseSession, preferredSession } from "../../../web/src/session/choose_session";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

const session = (id: string, state: SessionState) => create(SessionSchema, { id, state });
const plain = new URL("http://127.0.0.1:8080/");

test("TheFirstPlayingSessionIsPreferred", () => {
  const [a, b] = [session("a", SessionState.PAUSED), session("b", SessionState.PLAYING)];
  expect(preferredSession([a, b])).toBe(b);
  expect(preferredSession([a])).toBe(a);
  expect(preferredSession([])).toBeUndefined();
});

test("TheSessionInTheAddressIsUsed", async () => {
  const named = new URL("?session=mine", plain);
  expect(await chooseSession(named, new FakeServer().api, new FakeClock(), () => {})).toBe("mine");
});

test("AServerWithoutASessionIsPolled", async () => {
  const [server, clock, heard] = [new FakeServer(), new FakeClock(), [] as unknown[]];
  server.sessions = [];
  const chosen = chooseSession(plain, server.api, clock, (error) => heard.push(error));
  await settle();
  expect(heard).toEqual([undefined]);
  server.sessions = [server.session];
  await clock.advance(1500);
  expect(await chosen).toBe("thorax");
});

test("AnUnreachableServerIsPolled", async () => {
  const [server, clock, heard] = [new FakeServer(), new FakeClock(), [] as unknown[]];
  server.down = true;
  const chosen = chooseSession(plain, server.api, clock, (error) => heard.push(error));
  await settle();
  expect(String(heard[0])).toContain("connection refused");
  server.down = false;
  await clock.advance(500);
  expect(await chosen).toBe("thorax");
});
