// npm run mock: the built page with made-up data at http://127.0.0.1:8090, name "Dr. Weber", password "a long test password".

import { fileURLToPath } from "node:url";
import { MockServer } from "./server.ts";

const folder = process.env.TROCAR_WEB_FOLDER ?? fileURLToPath(new URL("../../../../data/web", import.meta.url));
const url = await new MockServer(folder).start(Number(process.env.PORT ?? 8090));
console.log(`mock server: ${url}`);
