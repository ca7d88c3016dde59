// Serves the page, opens it in a browser without a screen, and writes the zip that it sends: node capture.js OUT.zip [right] [reverse].
import fs from "node:fs";
import http from "node:http";
import os from "node:os";
import path from "node:path";
import {fileURLToPath} from "node:url";
import {chromium} from "playwright-core";

const here = path.dirname(fileURLToPath(import.meta.url));
const ROOTS = {"/modules/": path.join(here, "node_modules"), "/package/": path.dirname(here), "/": here};
const TYPES = {".html": "text/html", ".js": "text/javascript", ".json": "application/json"};
const FLAGS = ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync"];

function serve(request, response, settle) {
    const url = new URL(request.url, "http://localhost");
    if (request.method === "POST") {
        const chunks = [];
        request.on("data", (chunk) => chunks.push(chunk));
        request.on("end", () => {
            response.end();
            settle(url.pathname === "/result", Buffer.concat(chunks));
        });
        return;
    }
    const prefix = Object.keys(ROOTS).find((p) => url.pathname.startsWith(p));
    const file = path.join(ROOTS[prefix], path.normalize(decodeURIComponent(url.pathname.slice(prefix.length - 1))));
    fs.readFile(file, (error, data) => {
        response.writeHead(error ? 404 : 200, {"content-type": TYPES[path.extname(file)] ?? "application/octet-stream"});
        response.end(error ? "" : data);
    });
}

async function main([out, ...options]) {
    const profile = fs.mkdtempSync(path.join(os.tmpdir(), "glint-babylon-"));
    let settle;
    const sent = new Promise((resolve, reject) => {
        settle = (good, data) => (good ? resolve(data) : reject(new Error(data.toString())));
    });
    const server = http.createServer((request, response) => serve(request, response, settle)).listen(0, "127.0.0.1");
    await new Promise((resolve) => server.once("listening", resolve));
    const browser = await chromium.launchPersistentContext(profile, {
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args: FLAGS, viewport: {width: 640, height: 360}, deviceScaleFactor: 1,
    });
    try {
        const page = await browser.newPage();
        page.on("console", (message) => console.log(message.text()));
        page.on("pageerror", (error) => settle(false, Buffer.from(String(error))));
        page.on("crash", () => settle(false, Buffer.from("the page crashed")));
        await page.goto(`http://127.0.0.1:${server.address().port}/index.html?${options.map((o) => `${o}=1`).join("&")}`, {waitUntil: "commit"});
        const zip = await sent;
        fs.writeFileSync(`${out}.new`, zip);
        fs.renameSync(`${out}.new`, out);
    } finally {
        await browser.close();
        server.close();
        fs.rmSync(profile, {recursive: true, force: true});
    }
}

main(process.argv.slice(2)).catch((error) => {
    console.error(error.message);
    process.exit(1);
});
