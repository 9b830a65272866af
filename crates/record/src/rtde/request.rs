//! All that is ever sent to a robot.

/// A request. None of them sets an input of the controller.
pub(super) enum Request<'a> {
    /// Protocol version 2.
    Version,
    /// Outputs beside the time stamp, at a rate in Hz.
    Outputs(f64, &'a [&'a str]),
    /// Begin to send outputs.
    Start,
    /// Send no more outputs.
    Pause,
}

impl Request<'_> {
    /// As it is sent.
    pub fn bytes(&self) -> Vec<u8> {
        let (kind, content) = match self {
            Request::Version => (b'V', 2_u16.to_be_bytes().to_vec()),
            Request::Outputs(rate, names) => {
                let names = format!("timestamp,{}", names.join(","));
                (
                    b'O',
                    [rate.to_be_bytes().as_slice(), names.as_bytes()].concat(),
                )
            }
            Request::Start => (b'S', Vec::new()),
            Request::Pause => (b'P', Vec::new()),
        };
        let length = (3 + content.len()) as u16;
        [&length.to_be_bytes(), [kind].as_slice(), &content].concat()
    }
}
