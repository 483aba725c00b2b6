import { expect, test } from "vitest";
import { StudyState } from "../../../web/src/gen/phrenic/v1/study_pb";
import { Studies } from "../../../web/src/session/studies";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

test("AStudyIsWatchedToItsEnd", async () => {
  const server = new FakeServer();
  const studies = new Studies(server.api, new FakeClock());
  const seen: number[] = [];
  studies.all.subscribe((all) => all[0] !== undefined && seen.push(all[0].progress));
  await studies.start("cost", "thorax", undefined);
  await settle();
  expect(studies.all.value).toMatchObject([{ id: "cost-thorax", state: StudyState.DONE }]);
  expect(seen).toEqual([0, 0.5, 1]);
  expect((await studies.result("cost-thorax"))?.result?.tookS).toBe(2);
  await studies.remove("cost-thorax");
  expect(studies.all.value).toEqual([]);
});

test("ARefusalShowsTheServersMessage", async () => {
  const server = new FakeServer();
  const studies = new Studies(server.api, new FakeClock());
  await studies.start("cost", "", undefined);
  expect(studies.errorMessage.value).toBe("source.name: there is no scene");
  expect(studies.all.value).toEqual([]);
});
