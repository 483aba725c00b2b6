import { create } from "@bufbuild/protobuf";
import { Code, ConnectError } from "@connectrpc/connect";
import { beforeEach, describe, expect, test } from "vitest";
import { make } from "../../../../web/src/dom/elements";
import { Integrator, ParametersSchema } from "../../../../web/src/gen/phrenic/v1/parameters_pb";
import { type Session, SessionSchema } from "../../../../web/src/gen/phrenic/v1/session_pb";
import { parameterSections } from "../../../../web/src/panels/parameters/parameter_sections";
import { SessionController } from "../../../../web/src/session/session_controller";
import { FakeClock, settle } from "../../fakes/fake_clock";
import { FakeServer } from "../../fakes/fake_server";

let server: FakeServer;
let clock: FakeClock;
let controller: SessionController;
let panel: HTMLElement;

const list = () => panel.querySelector<HTMLSelectElement>("#parameter-integrator")!;
const using = (integrator: number): Session =>
  create(SessionSchema, { scene: "thorax", revision: 2n, parameters: create(ParametersSchema, { integrator }) });

beforeEach(() => {
  server = new FakeServer();
  clock = new FakeClock();
  controller = new SessionController(server.api, "thorax", clock);
  panel = make("div", {}, ...parameterSections(controller));
  document.body.replaceChildren(panel);
  controller.receive(using(Integrator.SEMI_IMPLICIT_EULER));
});

describe("a choice in the control panel", () => {
  test("OffersTheNamedValuesWithHelp", () => {
    const values = Object.values(Integrator).filter((value) => typeof value === "number" && value !== 0);
    expect([...list().options].map(({ value }) => Number(value))).toEqual(values);
    expect(list().selectedOptions[0].textContent).toBe("Semi Implicit Euler");
    expect(list().title).toContain("How a step is taken");
  });

  test("IsInTheSolverSection", () => {
    const fold = list().closest("details")!;
    expect(fold.querySelector("summary")!.textContent).toBe("Solver");
    expect(fold.querySelector("#parameter-timeStep")).not.toBeNull();
    expect(fold.querySelector("#parameter-breathForce")).toBeNull();
  });

  test("SendsOnlyTheChosenValue", async () => {
    list().value = String(Integrator.SEMI_IMPLICIT_EULER);
    list().dispatchEvent(new Event("change"));
    await settle();
    expect(server.updates).toMatchObject([{ integrator: Integrator.SEMI_IMPLICIT_EULER }]);
    expect(server.updates[0]).not.toHaveProperty("timeStep");
  });

  test("ShowsTheChoiceOfAnotherViewer", () => {
    list().append(make("option", { value: "99" }, "Another"));
    controller.receive(using(99));
    expect(list().value).toBe("99");
    controller.receive(using(Integrator.SEMI_IMPLICIT_EULER));
    expect(list().value).toBe(String(Integrator.SEMI_IMPLICIT_EULER));
  });

  test("ResetsToTheValueOfTheScene", async () => {
    server.sceneParameters = { integrator: 99 as Integrator };
    panel.querySelector<HTMLButtonElement>('[title="Reset integrator"]')!.click();
    await settle();
    expect(server.updates).toMatchObject([{ integrator: 99 }]);
  });

  test("ShowsTheActualValueAfterARefusal", async () => {
    server.api.sessions.updateParameters = () => Promise.reject(new ConnectError("no", Code.InvalidArgument));
    list().append(make("option", { value: "99" }, "Another"));
    list().value = "99";
    list().dispatchEvent(new Event("change"));
    await clock.advance(100);
    expect(list().value).toBe(String(Integrator.SEMI_IMPLICIT_EULER));
  });
});
