"""The certificates of a contest: its own authority issues those of its courts (X.509, P-256)."""

import ipaddress
from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from typing import NamedTuple, Self

from cryptography import x509
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.hashes import SHA256
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    load_pem_private_key,
)
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

LIFE = timedelta(days=397)
"""Validity of a contest's certificates: a season and some weeks."""
_CLOCKS_DIFFER = timedelta(days=1)
_NAME = "LACOC contest"


class Pair(NamedTuple):
    """A certificate and its private key, both PEM."""

    certificate: bytes
    private_key: bytes


class Authority(NamedTuple):
    """The certificate authority of a contest."""

    certificate: x509.Certificate
    private_key: ec.EllipticCurvePrivateKey

    @classmethod
    def new(cls, now: datetime) -> Self:
        """Make a new authority.

        Args:
            now: time with a time zone.
        """
        key = ec.generate_private_key(ec.SECP256R1())
        name = _name(f"{_NAME} authority")
        certificate = (
            _builder(name, name, key, now)
            .not_valid_after(now + LIFE)
            .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
            .add_extension(_usage(key_cert_sign=True), critical=True)
            .sign(key, SHA256())
        )
        return cls(certificate, key)

    @classmethod
    def load(cls, pair: Pair) -> Self:
        """Read an authority from its certificate and private key.

        Raises:
            ValueError: if they can't be read or do not belong together.
        """
        key = load_pem_private_key(pair.private_key, None)
        certificate = x509.load_pem_x509_certificate(pair.certificate)
        if not isinstance(key, ec.EllipticCurvePrivateKey):
            raise ValueError("its key is of another kind")
        if certificate.public_key() != key.public_key():
            raise ValueError("certificate and key do not belong together")
        return cls(certificate, key)

    @property
    def ends(self) -> datetime:
        """When the authority and all certificates that it issued expire."""
        return self.certificate.not_valid_after_utc

    def pair(self) -> Pair:
        """Return the authority's certificate and private key, both PEM."""
        return _pair(self.certificate, self.private_key)

    def issue(self, hosts: Iterable[str], now: datetime) -> Pair:
        """Make a certificate for courts, valid as long as the authority.

        Args:
            hosts: names and IP addresses by which the courts are reached.
            now: time with a time zone.
        """
        key = ec.generate_private_key(ec.SECP256R1())
        names = x509.SubjectAlternativeName([_general_name(host) for host in hosts])
        vouched = x509.AuthorityKeyIdentifier.from_issuer_public_key(self.private_key.public_key())
        certificate = (
            _builder(_name(f"{_NAME} court"), self.certificate.subject, key, now)
            .not_valid_after(self.ends)
            .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
            .add_extension(_usage(digital_signature=True), critical=True)
            .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
            .add_extension(names, critical=False)
            .add_extension(vouched, critical=False)
            .sign(self.private_key, SHA256())
        )
        return _pair(certificate, key)


def hosts_of(certificate: bytes) -> list[str]:
    """List the names and IP addresses in a court's certificate.

    Args:
        certificate: the certificate, PEM.

    Raises:
        ValueError: if the bytes are no certificate, or the certificate names no hosts.
    """
    try:
        extensions = x509.load_pem_x509_certificate(certificate).extensions
        names = extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except (x509.ExtensionNotFound, x509.DuplicateExtension) as error:
        raise ValueError(str(error)) from None
    return [
        *names.get_values_for_type(x509.DNSName),
        *map(str, names.get_values_for_type(x509.IPAddress)),
    ]


def utc_now() -> datetime:
    """Return the present time, in UTC."""
    return datetime.now(UTC)


def _builder(
    name: x509.Name, issuer: x509.Name, key: ec.EllipticCurvePrivateKey, now: datetime
) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - _CLOCKS_DIFFER)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
    )


def _name(text: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, text)])


def _general_name(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        return x509.DNSName(host)


def _usage(*, key_cert_sign: bool = False, digital_signature: bool = False) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=digital_signature,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=key_cert_sign,
        crl_sign=key_cert_sign,
        encipher_only=False,
        decipher_only=False,
    )


def _pair(certificate: x509.Certificate, key: ec.EllipticCurvePrivateKey) -> Pair:
    private = key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
    return Pair(certificate.public_bytes(Encoding.PEM), private)
