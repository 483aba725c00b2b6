import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser, FrameLocator, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { isComplaint, launchBrowser } from "../browser";
import { Platform } from "./platform";
import { outFolder, Server } from "../server";

const folder = mkdtempSync(join(tmpdir(), "phrenic-lti-"));
const platform = new Platform();
let server: Server;
let browser: Browser;

const lessonFile = join(import.meta.dirname, "../../../web/public/lessons/paralysis.json");
const lesson = JSON.parse(readFileSync(lessonFile, "utf8")) as {
  steps: { title: string; question?: { answers: { words: string; right?: boolean }[] } }[];
};

beforeAll(async () => {
  await platform.start();
  const accounts = join(folder, "accounts");
  await Server.addAccount(accounts, "admin", "admin");
  writeFileSync(join(folder, "password"), "hidden\n");
  const flags = (url: string) => [
    ...platform.register(url),
    ...["--tokens", accounts, "--xapi-password", join(folder, "password")],
  ];
  server = await Server.start("none", flags);
  browser = await launchBrowser();
});

afterAll(async () => {
  await browser?.close();
  await server?.end();
  platform.end();
  rmSync(folder, { recursive: true });
});

/** Opens the course's page, which has the tool in a frame. */
async function open(user: string, kind = "open"): Promise<{ page: Page; tool: FrameLocator; complaints: string[] }> {
  const page = await (await browser.newContext({ viewport: { width: 1100, height: 760 } })).newPage();
  const complaints: string[] = [];
  page.on("console", (message) => isComplaint(message) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(`${platform.url}/course?user=${user}&kind=${kind}`);
  return { page, tool: page.frameLocator("#tool"), complaints };
}

async function until(condition: () => boolean): Promise<void> {
  for (let i = 0; i < 100 && !condition(); i++) await new Promise((done) => setTimeout(done, 100));
  expect(condition()).toBe(true);
}

/** Goes through the lesson and answers each question rightly. */
async function answerAll(tool: FrameLocator): Promise<number> {
  let questions = 0;
  for (const [i, { title, question }] of lesson.steps.entries()) {
    await tool.getByRole("heading", { name: title, exact: true }).waitFor();
    if (question !== undefined) {
      questions++;
      await tool.getByLabel(question.answers.find(({ right }) => right)!.words).check();
      await tool.getByRole("button", { name: "Check" }).click();
      await tool.locator('.answer[data-right="true"]').waitFor();
    }
    if (i + 1 < lesson.steps.length) await tool.getByRole("button", { name: "Next", exact: true }).click();
  }
  return questions;
}

test("ATeacherChoosesALessonAndALearnersAnswersBecomeAGrade", async () => {
  // A second attempt is of another learner.
  const { scores, statements, deepLinks } = platform.received;
  for (const list of [scores, statements, deepLinks]) list.length = 0;
  const anna = (platform.learner = `anna-${Date.now()}`);
  const choice = await open("theo", "choose");
  await choice.tool.getByRole("radio", { name: /^Paralysis/ }).check();
  await choice.page.screenshot({ path: join(outFolder, "lti-choice.png") });
  await choice.tool.getByRole("button", { name: "Add the lesson to the course" }).click();
  await choice.tool.getByText("The lesson was added.").waitFor();
  const [link] = deepLinks;
  const [item] = link!["https://purl.imsglobal.org/spec/lti-dl/claim/content_items"] as Record<string, unknown>[];
  expect(item).toMatchObject({
    type: "ltiResourceLink",
    custom: { lesson: "paralysis" },
    lineItem: { scoreMaximum: 2 },
  });
  expect(link).toMatchObject({ aud: platform.url, "https://purl.imsglobal.org/spec/lti-dl/claim/data": "d" });
  expect(choice.complaints).toEqual([]);

  const learner = await open(anna);
  const questions = await answerAll(learner.tool);
  await learner.page.screenshot({ path: join(outFolder, "lti-lesson.png") });
  await until(() => scores.length > 0 && statements.length === questions + 2);
  expect(scores[0]).toMatchObject({
    path: "/items/1/scores",
    body: { userId: anna, scoreGiven: questions, scoreMaximum: questions, gradingProgress: "FullyGraded" },
  });
  const verbs = statements.map(({ verb }) => (verb as { id: string }).id.split("/").at(-1));
  expect(verbs).toEqual(["launched", ...Array<string>(questions).fill("answered"), "completed"]);
  expect(statements.at(-1)).toMatchObject({
    actor: { account: { homePage: platform.url, name: anna } },
    result: { completion: true, score: { scaled: 1 } },
  });
  expect(learner.complaints).toEqual([]);

  const teacher = await open("theo");
  await teacher.tool.getByRole("button", { name: "Next", exact: true }).click();
  await teacher.tool.getByText("Answers of the class", { exact: true }).click();
  await teacher.tool
    .getByText(/\d answered, \d right/)
    .first()
    .waitFor();
  await teacher.tool.locator("#class-results input[type=checkbox]").check();
  await teacher.tool.getByText("Anna Example").first().waitFor();
  await teacher.page.screenshot({ path: join(outFolder, "lti-teacher.png") });
  expect(teacher.complaints).toEqual([]);
  for (const { page } of [choice, learner, teacher]) await page.context().close();
});

test("AForgedLaunchIsRefusedInPlainWords", async () => {
  /** Begins a launch and returns what its second request needs. */
  const begin = async () => {
    const query = new URLSearchParams({
      iss: platform.url,
      login_hint: "anna",
      target_link_uri: `${server.url}lti/launch`,
    });
    const response = await fetch(`${server.url}lti/login?${query}`, { redirect: "manual" });
    const asked = new URL(response.headers.get("location")!).searchParams;
    const cookie = response.headers.get("set-cookie")!.split(";")[0]!;
    return { state: asked.get("state")!, nonce: asked.get("nonce")!, cookie };
  };
  const post = async (state: string, cookie: string, token: string) => {
    const body = new URLSearchParams({ state, id_token: token });
    const headers = { cookie, origin: platform.url };
    const response = await fetch(`${server.url}lti/launch`, { method: "POST", body, headers, redirect: "manual" });
    return { status: response.status, text: await response.text() };
  };
  for (const [change, algorithm, words] of [
    [{ aud: "other" }, "RS256", "for another tool (aud)"],
    [{ exp: 1_000_000_000 }, "RS256", "has expired (exp)"],
    [{ nonce: "old" }, "RS256", "(nonce)"],
    [
      { "https://purl.imsglobal.org/spec/lti/claim/target_link_uri": "https://evil.example/" },
      "RS256",
      "another server",
    ],
    [{}, "none", "cannot be trusted"],
    [{}, "HS256", "cannot be trusted"],
  ] as const) {
    const { state, nonce, cookie } = await begin();
    const claims = { ...platform.claims("anna", "open", nonce), ...change };
    const { status, text } = await post(state, cookie, platform.signed(claims, algorithm));
    expect([401, 403]).toContain(status);
    expect(text).toContain(words);
  }
  const { state, nonce, cookie } = await begin();
  const token = platform.signed(platform.claims("anna", "open", nonce));
  expect((await post(state, "", token)).status).toBe(401);
  expect((await post(state, cookie, token)).status).toBe(303);
  expect((await post(state, cookie, token)).text).toContain("used already");
  const page = await fetch(server.url);
  expect(page.headers.get("content-security-policy")).toContain(`frame-ancestors ${platform.url}`);
  const known = await fetch(`${server.url}lti/login?iss=https://evil.example&login_hint=1`, { redirect: "manual" });
  expect(known.status).toBe(403);
});
