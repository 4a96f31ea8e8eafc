//! Text into a page: everything that may come from a recording goes through [`escape`].

/// Safe between tags and between quotes.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            // Neither XML nor HTML has a form for these.
            control if control.is_control() && !control.is_whitespace() => safe.push('\u{fffd}'),
            other => safe.push(other),
        }
    }
    safe
}

/// A paragraph of plain text.
pub fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escape(text))
}

/// A section with its heading; `body` is HTML.
pub fn section(id: &str, title: &str, body: &str) -> String {
    format!("<section id=\"{id}\">\n<h2>{}</h2>\n{body}</section>\n", escape(title))
}

/// A picture with its caption (plain text).
pub fn figure(svg: &str, caption: &str) -> String {
    format!("<figure>\n<div class=\"wide\">{svg}</div>\n<figcaption>{}</figcaption>\n</figure>\n", escape(caption))
}

/// A table of plain text; columns whose heading ends in `#` hold numbers.
pub fn table(headings: &[&str], rows: &[Vec<String>]) -> String {
    let class = |k: usize| if headings[k].ends_with('#') { " class=\"number\"" } else { "" };
    let mut text = String::from("<div class=\"wide\"><table>\n<thead><tr>");
    for (k, heading) in headings.iter().enumerate() {
        text += &format!("<th{}>{}</th>", class(k), escape(heading.trim_end_matches('#')));
    }
    text += "</tr></thead>\n<tbody>\n";
    for row in rows {
        text += "<tr>";
        for (k, cell) in row.iter().enumerate().take(headings.len()) {
            text += &format!("<td{}>{}</td>", class(k), escape(cell));
        }
        text += "</tr>\n";
    }
    text + "</tbody></table></div>\n"
}

/// A list of terms; both plain text.
pub fn definitions(pairs: &[(&str, String)]) -> String {
    let mut text = String::from("<dl>\n");
    for (term, meaning) in pairs {
        text += &format!("<dt>{}</dt><dd>{}</dd>\n", escape(term), escape(meaning));
    }
    text + "</dl>\n"
}
