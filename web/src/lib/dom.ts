// Elements from code. Every text goes in as a text node, never as HTML.

export type Child = Node | string | number | null | undefined | false | Child[];

type Handlers = { [K in keyof HTMLElementEventMap]?: (event: HTMLElementEventMap[K]) => void };

export interface Attributes {
  /** Styles are set through the CSSOM, because the server's policy forbids style attributes. */
  style?: Record<string, string>;
  on?: Handlers;
  value?: string;
  [name: string]: unknown;
}

function append(parent: Node, child: Child): void {
  if (child === null || child === undefined || child === false) return;
  if (Array.isArray(child)) child.forEach((one) => append(parent, one));
  else parent.appendChild(child instanceof Node ? child : document.createTextNode(String(child)));
}

function set_attributes(element: HTMLElement | SVGElement, attributes: Attributes): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name === "style") {
      for (const [property, text] of Object.entries(value as Record<string, string>)) element.style.setProperty(property, text);
    } else if (name === "on") {
      for (const [event, handler] of Object.entries(value as Record<string, EventListener>)) element.addEventListener(event, handler);
    } else if (name !== "value" || !("value" in element)) {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
}

/** An HTML element. Attributes that are null, undefined or false are left out; true gives an empty attribute. */
export function h<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  set_attributes(element, attributes);
  append(element, children);
  if (attributes.value !== undefined && "value" in element) (element as HTMLInputElement).value = attributes.value;
  return element;
}

/** An SVG element with presentation attributes. */
export function svg(tag: string, attributes: Attributes = {}, ...children: Child[]): SVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  set_attributes(element, attributes);
  append(element, children);
  return element;
}

export function replace_children(parent: Element, ...children: Child[]): void {
  parent.replaceChildren();
  append(parent, children);
}

let last_id = 0;
/** An id that no other element of the page has. */
export function new_id(prefix: string): string {
  last_id += 1;
  return `${prefix}-${last_id}`;
}
