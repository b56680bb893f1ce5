// Texts of the sources: those that go through t(), t_nodes() or plural(), and those that look like English and do not.

import { readdirSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import ts from "typescript";

export interface SourceTexts {
  /** English text and the first place that has it. */
  keys: Map<string, string>;
  /** Texts outside of these functions. */
  raw: string[];
  /** Calls whose text is not written there: nobody can translate it. */
  hidden: string[];
}

/** Attributes and options that nobody reads. */
const kUnread = new Set(["class", "viewBox", "stroke-dasharray", "transform", "font", "labelFont", "preserveAspectRatio", "aria-keyshortcuts", "aria-describedby", "Content-Type", "headers", "key"]);
/** Functions whose texts are names for the program. */
const kProgram = new Set(["querySelector", "querySelectorAll", "closest", "matches", "addEventListener", "getElementById", "matchMedia", "replace", "split", "setProperty", "path_with", "get"]);
/** The program's name, and names of fonts. */
const kNames = new Set(["Trocar", "system-ui, sans-serif", "600 13px system-ui, sans-serif", "Content-Type"]);

function name_of(expression: ts.Expression): string {
  return ts.isPropertyAccessExpression(expression) ? expression.name.text : ts.isIdentifier(expression) ? expression.text : "";
}
function looks_english(text: string): boolean {
  const words = text.replace(/Trocar/g, "");
  return !kNames.has(text) && !text.startsWith("/") && /^[A-Z][a-z]|\p{L}{2,}[.,:;)]? +[(“]?\p{L}|[A-Z][a-z]+ /u.test(words);
}
/** The texts that an argument may be: one, or the two of a choice. */
function texts_of(node: ts.Expression | undefined): string[] | null {
  if (node && ts.isStringLiteral(node)) return [node.text];
  if (node && ts.isConditionalExpression(node)) {
    const both = [texts_of(node.whenTrue), texts_of(node.whenFalse)];
    return both[0] && both[1] ? [...both[0], ...both[1]] : null;
  }
  return null;
}

export function texts_in(source: string, name: string, found: SourceTexts): void {
  const file = ts.createSourceFile(name, source, ts.ScriptTarget.ES2022, true);
  const place = (node: ts.Node): string => `${name}:${file.getLineAndCharacterOfPosition(node.getStart(file)).line + 1}`;
  const visit = (node: ts.Node): void => {
    if (ts.isImportDeclaration(node) || ts.isTypeNode(node) || ts.isInterfaceDeclaration(node)) return;
    if (ts.isCallExpression(node) || ts.isNewExpression(node)) {
      const called = name_of(node.expression);
      const given = [...(node.arguments ?? [])];
      const count = called === "t" || called === "t_nodes" ? 1 : called === "plural" ? 2 : 0;
      const first = called === "plural" ? 1 : 0;
      const keys = count ? given.slice(first, first + count).map(texts_of) : [];
      for (const texts of keys) {
        if (texts) texts.forEach((one) => found.keys.set(one, found.keys.get(one) ?? place(node)));
        else found.hidden.push(place(node));
      }
      if (count) return [...given.slice(0, first), ...given.slice(first + count)].forEach(visit);
      if (kProgram.has(called)) return given.filter((one) => !ts.isStringLiteralLike(one) && !ts.isTemplateExpression(one)).forEach(visit);
    }
    if (ts.isPropertyAssignment(node) && kUnread.has(node.name.getText(file).replace(/"/g, ""))) return;
    if (ts.isBinaryExpression(node) && node.operatorToken.kind === ts.SyntaxKind.EqualsEqualsEqualsToken) return;
    if (ts.isStringLiteralLike(node)) {
      if (looks_english(node.text)) found.raw.push(`${place(node)} ${node.text}`);
      return;
    }
    if (ts.isTemplateExpression(node)) {
      const fixed = [node.head.text, ...node.templateSpans.map((one) => one.literal.text)].join("\u0001");
      if (looks_english(fixed)) found.raw.push(`${place(node)} ${node.getText(file)}`);
    }
    node.forEachChild(visit);
  };
  visit(file);
}

export function source_texts(folder: string, except: string[]): SourceTexts {
  const found: SourceTexts = { keys: new Map(), raw: [], hidden: [] };
  const walk = (at: string): void => {
    for (const one of readdirSync(join(folder, at)).sort()) {
      const path = join(at, one);
      if (statSync(join(folder, path)).isDirectory()) walk(path);
      else if (path.endsWith(".ts") && !except.includes(path)) texts_in(readFileSync(join(folder, path), "utf8"), path, found);
    }
  };
  walk("");
  return found;
}
