//! NumPy arrays, alone or zipped, with the same bytes every time.

use super::FileError;
use npyz::WriterBuilder;
use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;

/// Named members of an `.npz` in order, each an `.npy` file.
#[derive(Debug, Default)]
pub(super) struct Members(Vec<(String, Vec<u8>)>);

impl Members {
    pub(super) fn add(&mut self, name: &str, npy: Vec<u8>) {
        self.0.push((name.into(), npy));
    }

    /// The zip archive, deflated, with a fixed date.
    pub(super) fn zip(self) -> Vec<u8> {
        let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default()
            .compression_method(zip::CompressionMethod::Deflated)
            // Digits hardly shrink: more effort costs most of the time and saves a few per cent.
            .compression_level(Some(1))
            .last_modified_time(zip::DateTime::default())
            .large_file(true);
        for (name, bytes) in self.0 {
            zip.start_file(format!("{name}.npy"), options).expect("memory is writable");
            zip.write_all(&bytes).expect("memory is writable");
        }
        zip.finish().expect("memory is writable").into_inner()
    }
}

/// An array of any plain type as `.npy`.
pub(super) fn array<T: npyz::AutoSerialize + Clone>(shape: &[u64], values: &[T]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut writer =
        npyz::WriteOptions::new().default_dtype().shape(shape).writer(&mut out).begin_nd().expect("a plain type");
    writer.extend(values.iter().cloned()).expect("memory is writable");
    writer.finish().expect("memory is writable");
    out
}

/// A scalar byte string, as SciPy stores the name of a sparse format.
pub(super) fn byte_string(text: &str) -> Vec<u8> {
    let mut out = Vec::new();
    let dtype = npyz::DType::Plain(format!("|S{}", text.len()).parse().expect("a valid type"));
    let mut writer =
        npyz::WriteOptions::<Vec<u8>>::new().dtype(dtype).shape(&[]).writer(&mut out).begin_nd().expect("bytes");
    writer.push(&text.as_bytes().to_vec()).expect("memory is writable");
    writer.finish().expect("memory is writable");
    out
}

/// An array of texts (`<U...`), which NumPy reads without pickle.
pub(super) fn texts(list: &[String]) -> Vec<u8> {
    let longest = list.iter().map(|t| t.chars().count()).max().unwrap_or(0).max(1);
    let mut header = format!("{{'descr': '<U{longest}', 'fortran_order': False, 'shape': ({},), }}", list.len());
    // Magic, version and length take 10 bytes, the line end one; the data begin at a multiple of 64.
    header.push_str(&" ".repeat((64 - (11 + header.len()) % 64) % 64));
    header.push('\n');
    let mut out = b"\x93NUMPY\x01\x00".to_vec();
    out.extend((header.len() as u16).to_le_bytes());
    out.extend(header.as_bytes());
    for text in list {
        let padded = text.chars().map(u32::from).chain(std::iter::repeat(0)).take(longest);
        padded.for_each(|c| out.extend(c.to_le_bytes()));
    }
    out
}

/// Members of an `.npz` by name, undone.
pub(super) fn unzip(path: &Path, bytes: &[u8]) -> Result<BTreeMap<String, Vec<u8>>, FileError> {
    let broken = |e: &dyn std::fmt::Display| {
        FileError::new(path, format!("is not a readable .npz: {e}"))
            .mend("is it cut off, or another kind of file? save it again with numpy.savez or scipy.sparse.save_npz")
    };
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).map_err(|e| broken(&e))?;
    let mut members = BTreeMap::new();
    for k in 0..zip.len() {
        let mut file = zip.by_index(k).map_err(|e| broken(&e))?;
        let name = file.name().map_err(|e| broken(&e))?.trim_end_matches(".npy").to_string();
        let mut content = Vec::new();
        file.read_to_end(&mut content).map_err(|e| broken(&e))?;
        members.insert(name, content);
    }
    Ok(members)
}

/// Shape and values of a real or integer array, as f64. Integers beyond 2^53 do not occur in our files.
pub(super) fn numbers(path: &Path, name: &str, npy: &[u8]) -> Result<(Vec<u64>, Vec<f64>), FileError> {
    let broken = |e: &dyn std::fmt::Display| {
        FileError::new(path, format!("cannot be read: {e}"))
            .at(format!("array \"{name}\""))
            .mend("is it cut off? save it again as a plain array of float64")
    };
    // A damaged shape must not ask for memory, and npyz multiplies it unchecked.
    if values_announced(npy).is_some_and(|n| n > npy.len() as u64) {
        return Err(broken(&"its shape needs more bytes than there are"));
    }
    let open = || npyz::NpyFile::new(npy).map_err(|e| broken(&e));
    let header = open()?;
    let shape = header.shape().to_vec();
    if header.order() == npyz::Order::Fortran && shape.len() > 1 {
        return Err(broken(&"it is stored in Fortran order").mend("save numpy.ascontiguousarray(...)"));
    }
    let dtype = header.dtype().descr();
    let kind = dtype.trim_matches('\'').trim_start_matches(['<', '|', '=']).to_string();
    macro_rules! read {
        ($t:ty) => {{
            let values: Result<Vec<$t>, _> = open()?.into_vec::<$t>();
            values.map_err(|e| broken(&e))?.into_iter().map(|x| x as f64).collect()
        }};
    }
    let values = match kind.as_str() {
        "f8" => read!(f64),
        "f4" => read!(f32),
        "i8" => read!(i64),
        "i4" => read!(i32),
        "u4" => read!(u32),
        "u8" => read!(u64),
        other => return Err(broken(&format!("type {other} is not supported")).mend("save float64 values")),
    };
    Ok((shape, values))
}

/// The product of the numbers after `'shape'` in the header, as far as 64 bits go; `None` if there is no such thing.
fn values_announced(npy: &[u8]) -> Option<u64> {
    let header = &npy[..npy.len().min(1 << 16)];
    let at = header.windows(7).position(|w| w == b"'shape'")?;
    let tuple = header[at..].split(|b| *b == b'(').nth(1)?.split(|b| *b == b')').next()?;
    let sizes = tuple.split(|b| *b == b',').map(|d| String::from_utf8_lossy(d).trim().to_string());
    let size = |d: String| d.trim_end_matches('L').parse::<u64>().unwrap_or(u64::MAX);
    Some(sizes.filter(|d| !d.is_empty()).map(size).fold(1, u64::saturating_mul))
}

/// Text of a scalar string array (bytes or unicode); SciPy writes either.
pub(super) fn text(npy: &[u8]) -> String {
    // The payload follows the header's closing newline; NULs pad both encodings.
    let payload = npy.iter().position(|b| *b == b'\n').map_or(&npy[..0], |k| &npy[k + 1..]);
    payload.iter().filter(|b| **b != 0).map(|b| char::from(*b)).collect()
}
