import { expect, test } from "vitest";
import { Credentials } from "../../../web/src/connection/credentials";
import { Identity } from "../../../web/src/connection/identity";
import { userStorage } from "../../../web/src/connection/launch";

function memory() {
  const kept = new Map<string, string>();
  return {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => void kept.set(key, value),
  };
}

const [join, respondent] = ["0".repeat(32), "a".repeat(32)];

test("ALaunchIsKeptInItsTabAlone", () => {
  const [own, tab] = [memory(), memory()];
  own.setItem("phrenic-respondent", "of-the-pupil-before-this-one");
  const address = new URL(`http://host/?session=s#launch=1&join=${join}&respondent=${respondent}`);
  const storage = userStorage(address, own, tab);
  expect(storage).toBe(tab);
  expect(new Identity(storage).respondent).toBe(respondent);
  expect(new Identity(storage).isGraded).toBe(true);
  expect(new Credentials(storage).joinLinks).toEqual([join]);
  expect(new Credentials(storage).token).toBe("");
  expect(own.getItem("phrenic-links")).toBe(null);
  expect(userStorage(new URL("http://host/?session=s"), own, tab)).toBe(tab);
});

test("ASecondLaunchReplacesTheFirst", () => {
  const tab = memory();
  userStorage(new URL(`http://host/#launch=1&join=${join}&respondent=${respondent}`), memory(), tab);
  const teacher = new URL(`http://host/?session=s#launch=1&account=${join}&control=${respondent}`);
  const storage = userStorage(teacher, memory(), tab);
  expect(new Identity(storage).tokenOf("s")).toBe(respondent);
  expect(new Identity(storage).name).toBe("Teacher");
  expect(new Identity(storage).launched).toBe(true);
  expect(new Identity(storage).isGraded).toBe(false);
  expect(new Credentials(storage).joinLinks).toEqual([]);
  expect(new Credentials(storage).token).toBe(join);
  expect(new Identity(storage).respondent).not.toBe(respondent);
});

test("TheNextPageOfALaunchKeepsWhatWasAddedSince", () => {
  for (const fragment of [`account=${join}&control=${respondent}`, `join=${join}&respondent=${respondent}`]) {
    const tab = memory();
    const address = new URL(`http://host/?session=s#launch=1&${fragment}`);
    const identity = new Identity(userStorage(address, memory(), tab));
    identity.storeToken("s", "handed-over");
    identity.storeToken("fork", "of-a-fork");
    new Credentials(tab).addJoinLink("1".repeat(32));
    userStorage(new URL(`http://host/?session=fork#launch=1&${fragment}`), memory(), tab);
    expect(identity.tokenOf("s")).toBe("handed-over");
    expect(identity.tokenOf("fork")).toBe("of-a-fork");
    expect(new Credentials(tab).joinLinks).toContain("1".repeat(32));
  }
});

test("AnotherLaunchOfATeacherAddsItsTokenAndALearnerGetsNone", () => {
  const tab = memory();
  const launch = (fragment: string) => userStorage(new URL(`http://host/${fragment}`), memory(), tab);
  launch(`?session=a#launch=1&account=${join}&control=${respondent}`);
  const identity = new Identity(launch(`?session=b#launch=1&account=${respondent}&control=${join}`));
  expect([identity.tokenOf("a"), identity.tokenOf("b")]).toEqual([respondent, join]);
  launch(`?session=a#launch=1&join=${join}&respondent=${respondent}`);
  expect([identity.tokenOf("a"), identity.tokenOf("b")]).toEqual(["", ""]);
});

test("WhatIsNoSecretIsNotKept", () => {
  const storage = userStorage(new URL("http://host/#launch=1&join=<b>&account=x"), memory(), memory());
  expect(new Credentials(storage).joinLinks).toEqual([]);
  expect(new Credentials(storage).token).toBe("");
});

test("APageWithoutALaunchIsAsBefore", () => {
  const own = memory();
  expect(userStorage(new URL(`http://host/#join=${join}`), own, memory())).toBe(own);
  expect(new Identity(own).launched).toBe(false);
});
