import { beforeEach, describe, expect, test } from "vitest";
import { dropZone } from "../../../../web/src/app/drop_zone";
import type { Dropped } from "../../../../web/src/patient/patient_files";
import { make } from "../../../../web/src/dom/elements";
import { decodeBody } from "../../../../web/src/geometry/bodies";
import { ComparisonCard } from "../../../../web/src/panels/comparison/comparison_card";
import { distancePanel } from "../../../../web/src/panels/comparison/distance_panel";
import { Comparisons } from "../../../../web/src/session/comparisons";
import { Signal } from "../../../../web/src/state/signal";
import { settle } from "../../fakes/fake_clock";
import { FakeServer, triangleBody } from "../../fakes/fake_server";

let server: FakeServer;
let comparisons: Comparisons;
const bodies = new Signal([
  decodeBody(triangleBody({ name: "ball" })),
  decodeBody(triangleBody({ name: "wire", triangles: new Uint8Array() })),
]);
const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

beforeEach(() => {
  server = new FakeServer();
  server.comparisonEvents = [
    { case: "vertices", value: { distances: [0, 1, 4] } },
    {
      case: "table",
      value: { b: "b.obj", stateA: { body: "ball", tick: 1200n, time: 1.2 }, rows: [{ distance: { hdMax: 4 } }] },
    },
  ];
  comparisons = new Comparisons(server.api, "s");
});

describe("the panel", () => {
  beforeEach(() => document.body.replaceChildren(distancePanel(comparisons, bodies, new Signal([".obj", ".vtp"]))));

  test("HasALabelForEveryInput", () => {
    for (const each of document.querySelectorAll<HTMLInputElement | HTMLSelectElement>("input, select")) {
      expect(Boolean(each.ariaLabel || each.labels?.length), each.id).toBe(true);
    }
  });

  test("OffersBodiesWithASurface", () => {
    expect([...byId<HTMLSelectElement>("compare-body").options].map(({ value }) => value)).toEqual(["ball"]);
  });

  test("SetsUnitAndTime", () => {
    const change = (id: string, value: string) => {
      const input = byId<HTMLInputElement>(id);
      input.value = value;
      input.onchange?.(new Event("change"));
    };
    change("compare-unit", "1000");
    change("compare-time", "0.5");
    expect(comparisons.choices.value).toMatchObject({ unitMm: 1000, time: 0.5 });
    change("compare-time", "");
    expect(comparisons.choices.value.time).toBeUndefined();
  });
});

describe("the card", () => {
  let card: ComparisonCard;
  beforeEach(() => {
    card = new ComparisonCard(comparisons);
    document.body.replaceChildren(card.element);
  });

  test("IsHiddenWithoutAComparison", async () => {
    expect(card.element.hidden).toBe(true);
    await comparisons.compare(new File(["v 0 0 0"], "b.obj"));
    expect(card.element.hidden).toBe(false);
    byId("compare-clear").click();
    expect(card.element.hidden).toBe(true);
  });

  test("ShowsTheComparedTimeAndTheCurrentOne", async () => {
    await comparisons.compare(new File(["v 0 0 0"], "b.obj"));
    expect(byId("comparison-when").textContent).toBe("ball at 1.200 s, tick 1200");
    card.show(1.2);
    expect(byId("comparison-time").textContent).toBe("");
    card.show(2.5);
    expect(byId("comparison-time").textContent).toBe("The session is at 2.50 s now.");
  });

  test("ShowsProgressAndStops", async () => {
    server.comparisonEvents = [{ case: "progress", value: 0.4 }, new Promise(() => {})];
    void comparisons.compare(new File(["v 0 0 0"], "b.obj"));
    await settle();
    const bar = card.element.querySelector("progress")!;
    expect([bar.value, Boolean(bar.ariaLabel)]).toEqual([0.4, true]);
    expect(card.element.querySelector('[role="status"]')!.textContent).toContain("b.obj");
    card.element.querySelector("button")!.click();
    expect([card.element.hidden, comparisons.progress.value.kind]).toEqual([true, "idle"]);
  });

  test("ShowsAFailureAsAnAlertThatCanBeDismissed", async () => {
    server.comparisonEvents = [];
    await comparisons.compare(new File(["v 0 0 0"], "b.obj"));
    expect(card.element.querySelector('[role="alert"]')!.textContent).toContain("without a result");
    card.element.querySelector("button")!.click();
    expect(card.element.hidden).toBe(true);
  });
});

describe("dropping", () => {
  const drag = (type: string, transfer: object) =>
    Object.assign(new Event(type, { bubbles: true, cancelable: true }), { dataTransfer: transfer });

  test("AcceptsAFileAndShowsAHint", () => {
    const page = make("div");
    const taken: File[] = [];
    const labels: Dropped[] = [];
    const zone = dropZone(
      page,
      (file) => taken.push(file),
      (dropped) => labels.push(dropped),
    );
    const file = new File([""], "b.obj");
    page.dispatchEvent(drag("dragover", { types: ["Files"], files: [] }));
    expect(zone.hidden).toBe(false);
    const drop = drag("drop", { types: ["Files"], files: [file] });
    page.dispatchEvent(drop);
    expect([zone.hidden, drop.defaultPrevented]).toEqual([true, true]);
    expect(taken).toEqual([file]);
    for (const names of [["a.nii.gz"], ["b.dcm"], ["IM0001"], ["c.obj", "d.obj"]]) {
      const files = names.map((name) => new File([""], name));
      page.dispatchEvent(drag("drop", { types: ["Files"], files }));
      expect(labels.at(-1)?.files).toEqual(files);
    }
    expect(taken).toEqual([file]);
  });

  test("IgnoresDraggedText", () => {
    const page = make("div");
    const unwanted = () => expect.unreachable();
    const zone = dropZone(page, unwanted, unwanted);
    const over = drag("dragover", { types: ["text/plain"], files: [] });
    page.dispatchEvent(over);
    page.dispatchEvent(drag("drop", { types: ["text/plain"], files: [] }));
    expect([zone.hidden, over.defaultPrevented]).toEqual([true, false]);
  });
});
