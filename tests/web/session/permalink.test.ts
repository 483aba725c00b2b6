import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { ParametersSchema } from "../../../web/src/gen/phrenic/v1/parameters_pb";
import { SessionSchema } from "../../../web/src/gen/phrenic/v1/session_pb";
import { permalinkOf, recipeOf, rerun } from "../../../web/src/session/permalink";
import { FakeServer } from "../fakes/fake_server";

const parameters = create(ParametersSchema, { breathForce: 1 / 3, applyLinks: false, integrator: 4 });
const session = create(SessionSchema, { scene: "thorax", tick: 2500n, parameters });
const recipe = () => recipeOf(new URL(permalinkOf(session, "abc"), "http://here/"))!;

test("ALinkRestoresSceneHashTickAndExactParameters", () => {
  expect(recipe()).toEqual({ scene: "thorax", hash: "abc", tick: 2500, parameters });
  expect(recipeOf(new URL("http://here/?session=thorax"))).toBeUndefined();
  expect(() => recipeOf(new URL("http://here/?scene=thorax&tick=-1"))).toThrow("tick");
});

test("ARecipeIsRunToItsTick", async () => {
  const server = new FakeServer();
  const heard: number[] = [];
  expect(await rerun(server.api, recipe(), (part) => heard.push(part))).toBe("thorax-2");
  expect(server.created).toMatchObject([{ parameters }]);
  expect(server.stepRequests).toEqual([
    [0n, 1000n],
    [1000n, 1000n],
    [2000n, 500n],
  ]);
  expect(heard).toEqual([0.4, 0.8, 1]);
});

test("ASceneWithAnotherHashIsRefusedAndItsSessionDeleted", async () => {
  const server = new FakeServer();
  server.sceneHash = "def";
  await expect(rerun(server.api, recipe(), () => undefined)).rejects.toThrow("its hash is def");
  expect(server.deleted).toEqual(["thorax-2"]);
  expect(server.stepRequests).toEqual([]);
});
