import { expect, test } from "vitest";
import { Placement } from "../../../../web/src/gen/phrenic/v1/frames_pb";
import { MModePictures } from "../../../../web/src/panels/readings/m_mode_pictures";
import { triangleBody } from "../../fakes/fake_server";
import { decodeBody } from "../../../../web/src/geometry/bodies";

const diaphragm = { ...decodeBody(triangleBody({})), name: "diaphragm", placement: Placement.STREAMED };

test("OnlyASceneWithADiaphragmHasPictures", () => {
  const pictures = new MModePictures(10);
  pictures.start([{ ...diaphragm, name: "balloon" }]);
  expect(pictures.element.hidden).toBe(true);
  pictures.start([diaphragm]);
  expect(pictures.element.hidden).toBe(false);
});

test("TheSwitchShowsThem", () => {
  const pictures = new MModePictures(10);
  pictures.start([diaphragm]);
  document.body.replaceChildren(pictures.element);
  const list = pictures.element.querySelector<HTMLElement>(".m-mode-list")!;
  expect(list.hidden).toBe(true);
  pictures.element.querySelector("input")!.click();
  expect(list.hidden).toBe(false);
  expect(list.querySelectorAll("canvas").length).toBeGreaterThan(0);
});
