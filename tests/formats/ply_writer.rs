//! PLY files in binary, from the same in text.

/// A PLY file in text, with `format ascii 1.0` in its header, in another encoding.
///
/// The text is one of ours: an element a line, lists where the header has them.
pub fn encoded(text: &str, encoding: &str) -> Vec<u8> {
    let (header, body) = text.split_once("end_header\n").unwrap();
    let mut file = header.replace("format ascii", &format!("format {encoding}")).into_bytes();
    file.extend(b"end_header\n");
    if encoding == "ascii" {
        file.extend(body.as_bytes());
        return file;
    }
    let mut lines = body.lines().filter(|line| !line.trim().is_empty());
    for (count, types) in elements(header).into_iter().filter(|(_, types)| !types.is_empty()) {
        for _ in 0..count {
            let mut words = lines.next().unwrap().split_whitespace();
            let mut put = |scalar: &str, word: &str| file.extend(number(scalar, word, encoding));
            for kind in &types {
                let word = words.next().unwrap();
                match kind.strip_prefix("list ").and_then(|list| list.split_once(' ')) {
                    None => put(kind, word),
                    Some((length, item)) => {
                        put(length, word);
                        (0..word.parse().unwrap()).for_each(|_| put(item, words.next().unwrap()));
                    }
                }
            }
        }
    }
    file
}

/// The counts of a header's elements, each with the types of its properties, as the header spells them.
fn elements(header: &str) -> Vec<(usize, Vec<String>)> {
    let mut elements: Vec<(usize, Vec<String>)> = Vec::new();
    for line in header.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["element", _, count] => elements.push((count.parse().unwrap(), Vec::new())),
            ["property", ref kind @ .., _] => elements.last_mut().unwrap().1.push(kind.join(" ")),
            _ => {}
        }
    }
    elements
}

fn number(scalar: &str, word: &str, encoding: &str) -> Vec<u8> {
    let mut bytes = match scalar {
        "char" | "int8" => word.parse::<i8>().unwrap().to_le_bytes().to_vec(),
        "uchar" | "uint8" => word.parse::<u8>().unwrap().to_le_bytes().to_vec(),
        "short" | "int16" => word.parse::<i16>().unwrap().to_le_bytes().to_vec(),
        "ushort" | "uint16" => word.parse::<u16>().unwrap().to_le_bytes().to_vec(),
        "int" | "int32" => word.parse::<i32>().unwrap().to_le_bytes().to_vec(),
        "uint" | "uint32" => word.parse::<u32>().unwrap().to_le_bytes().to_vec(),
        "float" | "float32" => word.parse::<f32>().unwrap().to_le_bytes().to_vec(),
        "double" | "float64" => word.parse::<f64>().unwrap().to_le_bytes().to_vec(),
        other => panic!("{other}"),
    };
    if encoding == "binary_big_endian" {
        bytes.reverse();
    }
    bytes
}
