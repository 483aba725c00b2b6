import {
  createHmac,
  createPublicKey,
  generateKeyPairSync,
  type JsonWebKey,
  type KeyObject,
  randomUUID,
  sign,
  verify,
} from "node:crypto";
import { createServer, type IncomingMessage, type Server as HttpServer, type ServerResponse } from "node:http";

type Claims = Record<string, unknown>;
type Handler = (fields: URLSearchParams, request: IncomingMessage, response: ServerResponse) => void | Promise<void>;

const lti = "https://purl.imsglobal.org/spec/lti/claim/";
const membership = "http://purl.imsglobal.org/vocab/lis/v2/membership";
const ags = "https://purl.imsglobal.org/spec/lti-ags";
const nrps = "https://purl.imsglobal.org/spec/lti-nrps";

const encode = (value: unknown) => Buffer.from(JSON.stringify(value)).toString("base64url");
const decode = (part: string) => JSON.parse(Buffer.from(part, "base64url").toString()) as Claims;

/** What the platform has received. */
export interface Received {
  scores: { path: string; body: Claims }[];
  statements: Claims[];
  deepLinks: Claims[];
}

/**
 * A learning platform with one course, as 1EdTech's Security Framework 1.0, LTI 1.3, Deep Linking 2.0, Assignment and
 * Grade Services 2.0 and Names and Role Provisioning Services 2.0 have it, and a store of learning records. It shares
 * no code with the server.
 */
export class Platform {
  readonly received: Received = { scores: [], statements: [], deepLinks: [] };
  readonly client = "phrenic-client";
  /** The course's learner. */
  learner = "anna";
  /** The last form that it sent to the tool. */
  lastForm: Record<string, string> = {};
  private readonly key = newKey();
  private readonly http: HttpServer;
  private port = 0;
  private tool = "";
  /** Access tokens by the scope that they were given for. */
  private readonly tokens = new Map<string, string>();

  constructor() {
    const routes: Record<string, Handler> = {
      "/course": (fields, _, response) => this.course(fields, response),
      "/auth": (fields, _, response) => this.auth(fields, response),
      "/favicon.ico": (_, __, response) => end(response, 204, ""),
      "/keys": (_, __, response) => json(response, { keys: [this.key.jwk] }),
      "/token": (fields, _, response) => this.token(fields, response),
      "/items/1/scores": (fields, request, response) => this.score(fields, request, response),
      "/members": (_, request, response) => this.members(request, response),
      "/return": (fields, _, response) => this.deepLink(fields, response),
      "/xapi/statements": (fields, request, response) => this.statement(fields, request, response),
    };
    this.http = createServer((request, response) => {
      void (async () => {
        const url = new URL(request.url ?? "/", this.url);
        const body = await text(request);
        const isForm = request.headers["content-type"] === "application/x-www-form-urlencoded";
        const fields = new URLSearchParams(isForm ? body : request.method === "POST" ? { body } : url.search);
        const handler = routes[url.pathname];
        if (handler === undefined) return end(response, 404, "no such page");
        await handler(fields, request, response);
      })().catch((error: unknown) => end(response, 400, String(error)));
    });
  }

  async start(): Promise<void> {
    await new Promise<void>((done) => this.http.listen(0, "127.0.0.1", done));
    this.port = (this.http.address() as { port: number }).port;
  }

  end(): void {
    this.http.close();
    this.http.closeAllConnections();
  }

  /** Another site than the tool's 127.0.0.1, so that the tool's cookies are those of a third party. */
  get url(): string {
    return `http://localhost:${this.port}`;
  }

  /** Returns the settings of the tool at this address, and remembers it. */
  register(tool: string): string[] {
    this.tool = tool;
    const { url, client } = this;
    const platform = `issuer=${url} client=${client} deployment=d1 login=${url}/auth token=${url}/token keys=${url}/keys`;
    return ["--lti-url", tool, "--lti-platform", platform, "--xapi-url", `${url}/xapi`, "--xapi-user", "phrenic"];
  }

  /** Returns a token as the platform signs it; `algorithm` other than RS256 forges it. */
  signed(claims: Claims, algorithm = "RS256"): string {
    const input = `${encode({ alg: algorithm, kid: this.key.jwk.kid, typ: "JWT" })}.${encode(claims)}`;
    if (algorithm === "none") return `${input}.`;
    if (algorithm === "HS256") {
      const secret = createPublicKey(this.key.secret).export({ type: "spki", format: "pem" });
      return `${input}.${createHmac("sha256", secret).update(input).digest("base64url")}`;
    }
    return `${input}.${sign("RSA-SHA256", Buffer.from(input), this.key.secret).toString("base64url")}`;
  }

  /** Returns the claims of a launch by a learner, or by "theo", who teaches; `kind` "choose" is deep linking. */
  claims(user: string, kind: string, nonce: string): Claims {
    const now = Math.floor(Date.now() / 1000);
    const shared = {
      iss: this.url,
      aud: this.client,
      sub: user,
      iat: now,
      exp: now + 300,
      nonce,
      [`${lti}version`]: "1.3.0",
      [`${lti}deployment_id`]: "d1",
      [`${lti}context`]: { id: "course-1", title: "Biology" },
      [`${lti}roles`]: [`${membership}#${user === "theo" ? "Instructor" : "Learner"}`],
    };
    if (kind === "choose") {
      const settings = { deep_link_return_url: `${this.url}/return`, accept_types: ["ltiResourceLink"], data: "d" };
      const type = { [`${lti}message_type`]: "LtiDeepLinkingRequest" };
      return { ...shared, ...type, "https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings": settings };
    }
    return {
      ...shared,
      [`${lti}message_type`]: "LtiResourceLinkRequest",
      [`${lti}target_link_uri`]: `${this.tool}/lti/launch`,
      [`${lti}resource_link`]: { id: "link-1" },
      [`${lti}custom`]: { lesson: "paralysis", learners: "controller" },
      [`${ags}/claim/endpoint`]: { scope: [`${ags}/scope/score`], lineitem: `${this.url}/items/1` },
      [`${nrps}/claim/namesroleservice`]: { context_memberships_url: `${this.url}/members`, service_versions: ["2.0"] },
    };
  }

  /** A page of the course, with the tool in a frame. */
  private course(fields: URLSearchParams, response: ServerResponse): void {
    const login = new URLSearchParams({
      iss: this.url,
      client_id: this.client,
      login_hint: fields.get("user") ?? "",
      lti_message_hint: fields.get("kind") ?? "open",
      target_link_uri: `${this.tool}/lti/launch`,
    });
    const frame = `<iframe id="tool" title="Tool" src="${this.tool}/lti/login?${login}"></iframe>`;
    const style = "<style>body{margin:0}iframe{border:0;width:100vw;height:90vh}</style>";
    html(response, `<title>Course</title>${style}<h1>Biology</h1>${frame}`);
  }

  /** The authentication request of OpenID Connect, answered by a form that posts itself. */
  private auth(fields: URLSearchParams, response: ServerResponse): void {
    const wanted = { response_type: "id_token", response_mode: "form_post", scope: "openid", prompt: "none" };
    for (const [name, value] of Object.entries(wanted)) if (fields.get(name) !== value) throw new Error(name);
    if (fields.get("client_id") !== this.client) throw new Error("client_id");
    if (fields.get("redirect_uri") !== `${this.tool}/lti/launch`) throw new Error("redirect_uri");
    const [user, kind] = [fields.get("login_hint") ?? "", fields.get("lti_message_hint") ?? ""];
    const token = this.signed(this.claims(user, kind, fields.get("nonce") ?? ""));
    this.lastForm = { id_token: token, state: fields.get("state") ?? "" };
    const inputs = Object.entries(this.lastForm).map(([name, value]) => `<input name="${name}" value="${value}">`);
    const form = `<form method="post" action="${this.tool}/lti/launch">${inputs.join("")}</form>`;
    html(response, `${form}<script>document.forms[0].submit()</script>`);
  }

  /** Client credentials by a signed assertion (RFC 7523). */
  private async token(fields: URLSearchParams, response: ServerResponse): Promise<void> {
    if (fields.get("grant_type") !== "client_credentials") throw new Error("grant_type");
    const claims = await this.verified(fields.get("client_assertion") ?? "");
    if (claims.iss !== this.client || claims.sub !== this.client || claims.aud !== `${this.url}/token`)
      throw new Error("client_assertion");
    const token = randomUUID();
    this.tokens.set(token, fields.get("scope") ?? "");
    json(response, { access_token: token, token_type: "Bearer", expires_in: 3600 });
  }

  private admit(request: IncomingMessage, scope: string): void {
    const token = (request.headers.authorization ?? "").replace("Bearer ", "");
    if (this.tokens.get(token) !== scope) throw new Error("scope");
  }

  private score(fields: URLSearchParams, request: IncomingMessage, response: ServerResponse): void {
    this.admit(request, `${ags}/scope/score`);
    if (request.headers["content-type"] !== "application/vnd.ims.lis.v1.score+json") throw new Error("content type");
    this.received.scores.push({ path: request.url ?? "", body: JSON.parse(fields.get("body") ?? "") as Claims });
    end(response, 204, "");
  }

  private members(request: IncomingMessage, response: ServerResponse): void {
    this.admit(request, `${nrps}/scope/contextmembership.readonly`);
    json(response, { members: [{ user_id: this.learner, name: "Anna Example", roles: ["Learner"] }] });
  }

  private async deepLink(fields: URLSearchParams, response: ServerResponse): Promise<void> {
    this.received.deepLinks.push(await this.verified(fields.get("JWT") ?? ""));
    html(response, "<title>Course</title><p>The lesson was added.</p>");
  }

  private statement(fields: URLSearchParams, request: IncomingMessage, response: ServerResponse): void {
    const basic = `Basic ${Buffer.from("phrenic:hidden").toString("base64")}`;
    if (request.headers.authorization !== basic) return end(response, 401, "");
    if (request.headers["x-experience-api-version"] !== "1.0.3") return end(response, 400, "");
    const statement = JSON.parse(fields.get("body") ?? "") as Claims;
    this.received.statements.push(statement);
    json(response, [statement.id]);
  }

  /** Returns the claims of a token that the tool has signed with a key that it publishes. */
  private async verified(token: string): Promise<Claims> {
    const [header = "", claims = "", signature = ""] = token.split(".");
    const { keys } = (await (await fetch(`${this.tool}/lti/jwks`)).json()) as {
      keys: (JsonWebKey & { kid: string })[];
    };
    const key = keys.find(({ kid }) => kid === decode(header).kid);
    if (key === undefined || decode(header).alg !== "RS256") throw new Error("key");
    const bytes = Buffer.from(signature, "base64url");
    if (!verify("RSA-SHA256", Buffer.from(`${header}.${claims}`), createPublicKey({ key, format: "jwk" }), bytes))
      throw new Error("signature");
    return decode(claims);
  }
}

function newKey(): { secret: KeyObject; jwk: JsonWebKey & { kid: string } } {
  const { privateKey, publicKey } = generateKeyPairSync("rsa", { modulusLength: 2048 });
  const jwk = { ...publicKey.export({ format: "jwk" }), kid: randomUUID(), alg: "RS256", use: "sig" };
  return { secret: privateKey, jwk: jwk as JsonWebKey & { kid: string } };
}

async function text(request: IncomingMessage): Promise<string> {
  let body = "";
  for await (const part of request) body += String(part);
  return body;
}

function end(response: ServerResponse, status: number, body: string, type = "text/plain"): void {
  response.writeHead(status, { "content-type": type }).end(body);
}

const html = (response: ServerResponse, body: string) =>
  end(response, 200, `<!doctype html><html lang="en">${body}</html>`, "text/html; charset=utf-8");
const json = (response: ServerResponse, value: unknown) =>
  end(response, 200, JSON.stringify(value), "application/json");
