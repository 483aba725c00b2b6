import { createRouterTransport } from "@connectrpc/connect";
import { expect, test } from "vitest";
import { createApi } from "../../../web/src/connection/api";
import { Credentials, credentialsInterceptor, storeJoinLink } from "../../../web/src/connection/credentials";
import { AccessService } from "../../../web/src/gen/phrenic/v1/access_pb";
import { signIn } from "../../../web/src/panels/session/sign_in";

class FakeStorage {
  private readonly items = new Map<string, string>();
  getItem(key: string): string | null {
    return this.items.get(key) ?? null;
  }
  setItem(key: string, value: string): void {
    this.items.set(key, value);
  }
}

/** A server that accepts one token and records the request headers. */
function server(credentials: Credentials) {
  const shown: Headers[] = [];
  const transport = createRouterTransport(
    ({ service }) => {
      service(AccessService, {
        getAccess(_, context) {
          shown.push(context.requestHeader);
          const name = context.requestHeader.get("authorization") === "Bearer good" ? "anna" : "";
          return { accounts: true, name };
        },
      });
    },
    { transport: { interceptors: [credentialsInterceptor(credentials)] } },
  );
  return { api: createApi(transport), shown };
}

const secret = "00112233445566778899aabbccddeeff";

test("the secret of a join link is read from the fragment only", () => {
  const access = new Credentials(new FakeStorage());
  storeJoinLink(new URL(`https://x/?session=a&join=${secret}`), access);
  storeJoinLink(new URL("https://x/?session=a#join=<script>"), access);
  expect(access.joinLinks).toEqual([]);
  storeJoinLink(new URL(`https://x/?session=a#join=${secret}`), access);
  storeJoinLink(new URL(`https://x/?session=a#join=${secret}`), access);
  expect(access.joinLinks).toEqual([secret]);
});

test("every call carries the credentials, if there are any", async () => {
  const access = new Credentials(new FakeStorage());
  const { api, shown } = server(access);
  await api.access.getAccess({});
  expect(shown[0]!.has("authorization") || shown[0]!.has("x-join")).toBe(false);
  access.token = "good";
  access.addJoinLink(secret);
  await api.access.getAccess({});
  expect(shown[1]!.get("authorization")).toBe("Bearer good");
  expect(shown[1]!.get("x-join")).toBe(secret);
});

test("the page asks until the server accepts the token", async () => {
  const access = new Credentials(new FakeStorage());
  const { api } = server(access);
  const place = document.createElement("div");
  const done = signIn(api, access, place);
  for (const [words, token] of [
    ["requires an account", "bad"],
    ["No account has this token", "good"],
  ] as const) {
    await expect.poll(() => place.textContent).toContain(words);
    const entry = place.querySelector("input")!;
    expect(entry.type).toBe("password");
    entry.value = token;
    place.querySelector("form")!.requestSubmit();
  }
  await done;
  expect(access.token).toBe("good");
});

test("a join link is sufficient without an account", async () => {
  const access = new Credentials(new FakeStorage());
  access.addJoinLink(secret);
  const place = document.createElement("div");
  await signIn(server(access).api, access, place);
  expect(place.childElementCount).toBe(0);
});
