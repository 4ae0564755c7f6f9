//! Numbers of arrays, as text or as bytes.

use crate::io::mesh_values::shown;

/// Numbers, or what is wrong and its mend.
pub(super) type Read<T = Vec<f64>> = Result<T, (String, &'static str)>;

/// Types of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Kind {
    pub(super) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "Int8" => Self::I8,
            "UInt8" => Self::U8,
            "Int16" => Self::I16,
            "UInt16" => Self::U16,
            "Int32" => Self::I32,
            "UInt32" => Self::U32,
            "Int64" => Self::I64,
            "UInt64" => Self::U64,
            "Float32" => Self::F32,
            "Float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of one number.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// The number in the last `size` of eight bytes, the most significant first.
    fn of(self, b: [u8; 8]) -> f64 {
        let bits = u64::from_be_bytes(b);
        match self {
            Self::I8 => f64::from(bits as i8),
            Self::I16 => f64::from(bits as i16),
            Self::I32 => f64::from(bits as i32),
            Self::I64 => bits as i64 as f64,
            Self::U8 | Self::U16 | Self::U32 | Self::U64 => bits as f64,
            Self::F32 => f64::from(f32::from_bits(bits as u32)),
            Self::F64 => f64::from_bits(bits),
        }
    }
}

/// Numbers written out; those that are not finite stay, so that whoever uses them can say where they stand.
pub(super) fn ascii(text: &str, kind: Kind) -> Read {
    let number = |(place, word): (usize, &str)| match word.parse::<f64>() {
        Ok(v) if kind.is_float() || v.fract() == 0.0 => Ok(v),
        _ => Err((format!("number {place} is \"{}\"", shown(word)), "write numbers of the type of the array")),
    };
    text.split_ascii_whitespace().enumerate().map(number).collect()
}

/// Numbers from bytes.
pub(super) fn binary(bytes: &[u8], kind: Kind, little: bool) -> Read {
    let size = kind.size();
    if !bytes.len().is_multiple_of(size) {
        let problem = format!("{} bytes are no whole number of items of {size}", bytes.len());
        return Err((problem, "is the type of the array right?"));
    }
    let number = |item: &[u8]| {
        let mut whole = [0; 8];
        whole[8 - size..].copy_from_slice(item);
        if little {
            whole[8 - size..].reverse();
        }
        kind.of(whole)
    };
    Ok(bytes.chunks_exact(size).map(number).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_byte_orders_give_the_same_numbers() {
        for little in [true, false] {
            let order = |mut b: Vec<u8>| {
                if !little {
                    b.reverse();
                }
                b
            };
            let one = |b: Vec<u8>, kind| binary(&order(b), kind, little).unwrap()[0];
            assert_eq!(one((-3i8).to_le_bytes().to_vec(), Kind::I8), -3.0);
            assert_eq!(one((-300i16).to_le_bytes().to_vec(), Kind::I16), -300.0);
            assert_eq!(one(70_000u32.to_le_bytes().to_vec(), Kind::U32), 70_000.0);
            assert_eq!(one((-70_000i64).to_le_bytes().to_vec(), Kind::I64), -70_000.0);
            assert_eq!(one(0.1f32.to_le_bytes().to_vec(), Kind::F32), f64::from(0.1f32));
            assert_eq!(one((-1e-300f64).to_le_bytes().to_vec(), Kind::F64), -1e-300);
        }
        assert!(binary(&[0; 7], Kind::F32, true).is_err());
        assert_eq!(ascii(" 1 2.5\n-3e2 ", Kind::F64).unwrap(), [1.0, 2.5, -300.0]);
        assert!(ascii("1 2.5", Kind::I32).is_err() && ascii("1 two", Kind::F32).is_err());
    }
}
