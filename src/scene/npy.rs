//! Arrays of numbers as NumPy saves them: `numpy.save("smoke.npy", density)`.
//!
//! NEP 1: six bytes of magic, the version, the header's length, then a Python dictionary with `descr`, `fortran_order` and
//! `shape`, then the numbers. The crates that read it bring a parser of Python along, with a dozen crates behind it; of the
//! dictionary these three entries are all there is.

/// Three axes of numbers, the last of which runs fastest.
#[derive(Debug, Clone, PartialEq)]
pub struct Array3 {
    pub shape: [usize; 3],
    pub values: Vec<f32>,
}

const MAGIC: &[u8] = b"\x93NUMPY";

/// Reads a whole file; the error says what is wrong and what is allowed.
pub fn read(bytes: &[u8]) -> Result<Array3, String> {
    let (header, data) = split(bytes).ok_or("not a NumPy array file")?;
    let entry = |key: &str| {
        let (_, rest) = header.split_once(&format!("'{key}':")).ok_or(format!("its header lacks '{key}'"))?;
        Ok::<_, String>(rest.trim_start())
    };
    if !entry("fortran_order")?.starts_with("False") {
        return Err("axes in Fortran order, expected C order".to_owned());
    }
    let shape = shape(entry("shape")?)?;
    let count = shape.iter().try_fold(1_usize, |product, &n| product.checked_mul(n)).ok_or("too many numbers")?;
    let descr = entry("descr")?.split('\'').nth(1).unwrap_or_default();
    let values = match descr {
        "<f4" => data.as_chunks().0.iter().map(|four| f32::from_le_bytes(*four)).collect::<Vec<_>>(),
        "<f8" => data.as_chunks().0.iter().map(|eight| f64::from_le_bytes(*eight) as f32).collect(),
        _ => return Err(format!("numbers of type '{descr}', expected '<f4' or '<f8'")),
    };
    match values.len() == count {
        true => Ok(Array3 { shape, values }),
        false => Err(format!("{} numbers, expected {count} for its shape {shape:?}", values.len())),
    }
}

/// The header's text and the bytes after it.
fn split(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let rest = bytes.strip_prefix(MAGIC)?;
    let (&[major, _minor], rest) = rest.split_first_chunk()?;
    let (length, rest) = match major {
        1 => rest.split_first_chunk().map(|(two, rest)| (usize::from(u16::from_le_bytes(*two)), rest))?,
        _ => rest.split_first_chunk().map(|(four, rest)| (u32::from_le_bytes(*four) as usize, rest))?,
    };
    let header = std::str::from_utf8(rest.get(..length)?).ok()?;
    Some((header, &rest[length..]))
}

fn shape(text: &str) -> Result<[usize; 3], String> {
    let inside = text.strip_prefix('(').and_then(|text| text.split_once(')')).map_or("", |(inside, _)| inside);
    let axes: Vec<&str> = inside.split(',').map(str::trim).filter(|axis| !axis.is_empty()).collect();
    let numbers: Option<Vec<usize>> = axes.iter().map(|axis| axis.parse().ok()).collect();
    numbers
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| format!("shape ({inside}), expected three axes: up, north, east"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, data: &[u8]) -> Vec<u8> {
        [MAGIC, &[1, 0], &(header.len() as u16).to_le_bytes(), header.as_bytes(), data].concat()
    }

    #[test]
    fn what_numpy_saves_is_read_and_the_last_axis_runs_fastest() {
        let data: Vec<u8> = (0..6).flat_map(|i| (i as f32).to_le_bytes()).collect();
        let saved = file("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 3), }          \n", &data);
        assert_eq!(read(&saved), Ok(Array3 { shape: [1, 2, 3], values: vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0] }));
        let double = file("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 1), }", &2.5_f64.to_le_bytes());
        assert_eq!(read(&double).unwrap().values, [2.5]);
    }

    #[test]
    fn what_is_not_such_an_array_is_refused_with_a_reason() {
        let refusal = |header: &str| read(&file(header, &[0; 8])).unwrap_err();
        assert!(read(b"PNG").unwrap_err().contains("not a NumPy"));
        assert!(refusal("{'descr': '<i4', 'fortran_order': False, 'shape': (2, 1, 1), }").contains("'<i4'"));
        assert!(refusal("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 1, 1), }").contains("C order"));
        assert!(refusal("{'descr': '<f4', 'fortran_order': False, 'shape': (2,), }").contains("three axes"));
        assert!(refusal("{'descr': '<f4', 'fortran_order': False, 'shape': (3, 1, 1), }").contains("2 numbers"));
    }
}
