// The little Markdown that hovers use: paragraphs, `code`, **bold**, fenced code.
import { element } from './dom';

export function markdown(text: string): DocumentFragment {
  const made = document.createDocumentFragment();
  text.split(/^```.*$/m).forEach((part, index) => {
    if (index % 2) {
      made.append(element('pre', {}, part.trim()));
      return;
    }
    for (const paragraph of part.split(/\n\s*\n/)) {
      if (paragraph.trim()) made.append(element('p', {}, ...inline(paragraph.trim())));
    }
  });
  return made;
}

function inline(text: string): (Node | string)[] {
  return text.split(/(`[^`]*`|\*\*[^*]+\*\*)/).map((piece) => {
    if (piece.startsWith('`') && piece.length > 1) return element('code', {}, piece.slice(1, -1));
    if (piece.startsWith('**') && piece.length > 4) return element('strong', {}, piece.slice(2, -2));
    return piece;
  });
}
